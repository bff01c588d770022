"""Sentences and labels that are filled in when they are shown; fields in braces stay as they are."""

from . import film, pins, surroundings

_REFUSALS = {
    "'{name}' has a profile, taper, extrusion, offset or point radii of its own; remove them first": (
        "'{name}' hat Profil, Verjüngung, Extrusion, Versatz oder Punktradien; diese zuerst entfernen"
    ),
    "'{name}' has no keys of Möbius Flow; press Relax first": (
        "'{name}' hat keine Schlüssel von Möbius Flow; zuerst Entspannen drücken"
    ),
    "'{name}' has no splines; give it at least one poly spline": (
        "'{name}' hat keine Splines; mindestens ein Poly-Spline ist nötig"
    ),
    "'{name}' has shape keys; remove them or relax a copy without them": (
        "'{name}' hat Formschlüssel; diese entfernen oder eine Kopie ohne sie entspannen"
    ),
    "'{name}' is a 2D curve; set its Shape to 3D first (Object Data properties)": (
        "'{name}' ist eine 2D-Kurve; zuerst ihre Form auf 3D stellen (Eigenschaften der Objektdaten)"
    ),
    "'{name}' is a library override; make it local first (Object > Relations > Make Local)": (
        "'{name}' überschreibt ein Objekt einer Bibliothek; zuerst lokal machen (Objekt > Beziehungen > Lokal machen)"
    ),
    "'{name}' is being edited; go back to Object Mode first": (
        "'{name}' wird gerade bearbeitet; zuerst in den Objektmodus zurückkehren"
    ),
    "'{name}' is hidden; show it first": "'{name}' ist verborgen; zuerst einblenden",
    "'{name}' is linked from another file; make it local first (Object > Relations > Make Local)": (
        "'{name}' ist aus einer anderen Datei verknüpft; zuerst lokal machen (Objekt > Beziehungen > Lokal machen)"
    ),
    "'{name}' is moved by {mover}, and curves relaxed together must keep their places; "
    "remove that, or relax each curve alone": (
        "'{name}' wird bewegt ({mover}), aber gemeinsam entspannte Kurven müssen an ihrem Ort bleiben; "
        "das entfernen oder jede Kurve einzeln entspannen"
    ),
    "'{name}' is moved by {mover}": "'{name}' wird bewegt ({mover})",
    "'{name}' would change its shape, as its parent's scale is uneven": (
        "'{name}' würde seine Form ändern, da sein übergeordnetes Objekt ungleichmäßig skaliert ist"
    ),
    "'{name}' has other keys or points than it was baked with; undo that, or relax a copy": (
        "'{name}' hat andere Schlüssel oder Punkte als beim Backen; das rückgängig machen oder eine Kopie entspannen"
    ),
    "'{name}' is of type {type}; select a curve object, or convert it with Object > Convert > Curve": (
        "'{name}' ist vom Typ {type}; ein Kurvenobjekt auswählen oder mit Objekt > Konvertieren > Kurve umwandeln"
    ),
    "'{name}' is open; close it first (Edit Mode, Curve > Toggle Cyclic)": (
        "'{name}' ist offen; zuerst schließen (Bearbeitungsmodus, Kurve > Toggle Cyclic)"
    ),
    "'{name}' is scaled to nothing in some direction; give it a scale other than 0": (
        "'{name}' ist in einer Richtung auf nichts skaliert; eine andere Skalierung als 0 wählen"
    ),
    "'{name}' shares its curve data '{data}' with other objects; make it single-user first "
    "(Object > Relations > Make Single User)": (
        "'{name}' teilt die Kurvendaten '{data}' mit anderen Objekten; zuerst einen einzelnen Benutzer erstellen "
        "(Objekt > Beziehungen > Einzelnen Benutzer erstellen)"
    ),
    "{deformer} moves its points, so that strands may be seen to cross; remove it, or relax a copy without it": (
        "{deformer} verschiebt die Punkte, sodass sich Stränge sichtbar kreuzen können; "
        "entfernen oder eine Kopie ohne das entspannen"
    ),
    "{names} is being relaxed; stop that first": "{names}: Entspannung läuft; diese zuerst beenden",
    "{names} were not baked together; select one of them at a time": (
        "{names} wurden nicht zusammen gebacken; immer nur eine Kurve auswählen"
    ),
    "Draw a flat closed curve and select it first": "Zuerst eine flache geschlossene Kurve zeichnen und auswählen",
    "Go back to Object Mode first": "Zuerst in den Objektmodus zurückkehren",
    "Keys of '{name}' were edited; undo that, or Bake Again": (
        "Schlüssel von '{name}' wurden bearbeitet; das rückgängig machen oder erneut backen"
    ),
    "Keys of '{name}' were edited; undo that, or remove the keys to relax the curve as it is": (
        "Schlüssel von '{name}' wurden bearbeitet; das rückgängig machen oder die Schlüssel entfernen, "
        "um die Kurve so zu entspannen, wie sie ist"
    ),
    "No relaxation was cancelled": "Es wurde keine Entspannung abgebrochen",
    "Nothing is being relaxed": "Es wird gerade nichts entspannt",
    "Nothing is the matter at any place of this curve": "Es gibt an dieser Kurve keine Stelle, die Probleme macht",
    "Nothing selected needs that": "Nichts Ausgewähltes braucht das",
    "Points of '{name}' are driven; remove the drivers or relax a copy without them": (
        "Punkte von '{name}' haben Treiber; diese entfernen oder eine Kopie ohne sie entspannen"
    ),
    "Select a curve object first": "Zuerst ein Kurvenobjekt auswählen",
    "Select a curve that was baked first": "Zuerst eine gebackene Kurve auswählen",
    "Spline {number} of '{name}' has fewer than {fewest} points; give it more, or delete it": (
        "Spline {number} von '{name}' hat weniger als {fewest} Punkte; Punkte hinzufügen oder den Spline löschen"
    ),
    "Spline {number} of '{name}' is a {kind} spline; convert it to Poly first "
    "(Edit Mode, Curve > Set Spline Type > Poly), or set Sample Splines": (
        "Spline {number} von '{name}' ist ein {kind}-Spline; zuerst in Poly umwandeln "
        "(Bearbeitungsmodus, Kurve > Splinetyp setzen > Poly) oder Splines abtasten einschalten"
    ),
    "The curve data of '{name}' is animated; remove the animation or relax a copy without it": (
        "Die Kurvendaten von '{name}' sind animiert; die Animation entfernen oder eine Kopie ohne sie entspannen"
    ),
    "The modifier '{modifier}' of '{name}'": "Der Modifikator '{modifier}' von '{name}'",
    "The parent of '{name}'": "Das Elternteil von '{name}'",
    "The relaxation is over; its keys are being written": (
        "Die Entspannung ist zu Ende; ihre Schlüssel werden gerade geschrieben"
    ),
    "The scene has no camera; add one first": "Die Szene hat keine Kamera; zuerst eine hinzufügen",
    "a constraint": "Beschränkung",
    "a driver": "Treiber",
    "an NLA track": "NLA-Spur",
    "animation": "Animation",
    "its parent": "Elternteil",
    "physics": "Physik",
    "{mover} of its parent": "{mover} des Elternteils",
    "{why}, and its keys were edited; undo one or the other": (
        "{why}, und die Schlüssel wurden bearbeitet; eines von beiden rückgängig machen"
    ),
    "{why}; remove that, or bake it and turn it alone": (
        "{why}; das entfernen oder die Kurve backen und einzeln drehen"
    ),
}

_ERRORS = {
    "'{name}' has splines that Blender draws nothing for; delete them, or convert all to Poly first": (
        "'{name}' hat Splines, für die Blender nichts zeichnet; diese löschen oder zuerst alle in Poly umwandeln"
    ),
    "Frames/Iterate is {value:g}; it must be from {low:g} to {high:g}": (
        "Bilder/Iteration ist {value:g}; erlaubt sind {low:g} bis {high:g}"
    ),
    "Hold at Start and Hold at End must be 0 frames or more": (
        "Ruhe am Anfang und Ruhe am Ende müssen 0 Bilder oder mehr sein"
    ),
    "Length is {length} frames, which leaves none to move in; it must be at least {least}, or the holds shorter": (
        "Länge ist {length} Bilder, sodass keines für die Bewegung bleibt; "
        "mindestens {least} wählen oder kürzere Ruhezeiten"
    ),
    "Memory ran out; all is as it was": "Der Speicher reicht nicht; alles ist, wie es war",
    "Memory ran out; all is as it was. Take fewer Vertices or Max Iterations": (
        "Der Speicher reicht nicht; alles ist, wie es war. Weniger Punkte oder Max. Iterationen wählen"
    ),
    "Point {point} of spline {spline} of '{name}' is not finite, or further away than anything; repair or delete it": (
        "Punkt {point} von Spline {spline} von '{name}' ist nicht endlich oder unermesslich weit weg; "
        "reparieren oder löschen"
    ),
    "Something went wrong; all is as it was": "Etwas ist schiefgegangen; alles ist, wie es war",
    "Spline {number} of '{name}' is drawn with only {count} points; raise its Resolution U, or give it more points": (
        "Spline {number} von '{name}' wird mit nur {count} Punkten gezeichnet; "
        "seine Auflösung U erhöhen oder Punkte hinzufügen"
    ),
    "Start Frame is {frame:.12g}; it must be from {first} to {last}": (
        "Startbild ist {frame:.12g}; erlaubt sind {first} bis {last}"
    ),
    "Start Frame or Length": "Startbild oder Länge",
    "Start Frame, Frames/Iterate or Max Iterations": "Startbild, Bilder/Iteration oder Max. Iterationen",
    "The animation would go on to frame {frame:.0f}, but Blender's last is {last}; give a smaller {what}": (
        "Die Animation ginge bis Bild {frame:.0f}, Blenders letztes ist aber {last}; {what} verkleinern"
    ),
    "The computation ended unexpectedly; perhaps memory ran out": (
        "Die Berechnung endete unerwartet; vielleicht reichte der Speicher nicht"
    ),
    "The curve is hidden, or not in this view layer; make it visible first": (
        "Die Kurve ist verborgen oder nicht auf dieser Ansichtsebene; zuerst sichtbar machen"
    ),
    "The curves have {count} points; minimum or saddle is told up to {most}": (
        "Die Kurven haben {count} Punkte; ob Minimum oder Sattel, lässt sich bis {most} sagen"
    ),
    "The drawing is not flat; draw it in a plane, or scale it flat along its normal": (
        "Die Zeichnung ist nicht flach; in einer Ebene zeichnen oder entlang der Normalen flach skalieren"
    ),
    "The preset {name} belongs to Möbius Flow; only your own can be removed": (
        "Die Voreinstellung {name} gehört zu Möbius Flow; nur eigene können entfernt werden"
    ),
    "There is no preset {name} any more; choose another one": (
        "Die Voreinstellung {name} gibt es nicht mehr; eine andere wählen"
    ),
    "{label} is {value:g}; it must be a number up to {most:g}": (
        "{label} ist {value:g}; erlaubt ist eine Zahl bis {most:g}"
    ),
    "{name} has a number beyond {most}, which is too much for a window; use smaller ones": (
        "{name} enthält eine Zahl über {most}, zu groß für die Arbeit im Fenster; kleinere wählen"
    ),
    "{names} changed since the relaxation ended; relax anew": (
        "{names}: seit dem Ende der Entspannung verändert; neu entspannen"
    ),
}

_RUN = {
    "'{name}' is being edited": "'{name}' wird bearbeitet",
    "'{name}' was deleted": "'{name}' wurde gelöscht",
    "'{name}' was given other curve data": "'{name}' hat andere Kurvendaten bekommen",
    "'{name}' was given shape keys": "'{name}' hat Formschlüssel bekommen",
    "'{name}' was moved against the others": "'{name}' wurde gegen die anderen verschoben",
    "A file was loaded; the relaxation of {names} has ended": (
        "Eine Datei wurde geladen; die Entspannung von {names} ist beendet"
    ),
    "At least": "Mindestens",
    "Cancelled": "Abgebrochen",
    "Cancelled; all is as it was": "Abgebrochen; alles ist, wie es war",
    "Done": "Fertig",
    "Energy {energy:.4f}": "Energie {energy:.4f}",
    "Failed": "Fehlgeschlagen",
    "Finishing": "Wird abgeschlossen",
    "Free of contact": "Berührungsfrei",
    "Iteration": "Iteration",
    "Iteration {index}": "Iteration {index}",
    "Lost": "Verloren",
    "Möbius Flow was disabled; all is as it was": "Möbius Flow wurde deaktiviert; alles ist, wie es war",
    "Paused": "Angehalten",
    "Points of '{name}' were added or removed": "Punkte von '{name}' wurden hinzugefügt oder entfernt",
    "Resume": "Fortsetzen",
    "Running": "Läuft",
    "Step": "Schritt",
    "Stopped before anything had moved": "Beendet, bevor sich etwas bewegt hat",
    "The window was closed; all is as it was": "Das Fenster wurde geschlossen; alles ist, wie es war",
    "Tube radius": "Röhrenradius",
    "Undone; the relaxation of {names} has ended": "Rückgängig gemacht; die Entspannung von {names} ist beendet",
    "Waiting for the render": "Wartet auf das Rendern",
    "among themselves": "untereinander",
    "and every curve is as it was": "und jede Kurve ist, wie sie war",
    "and the others are as they were": "und die anderen sind, wie sie waren",
    "converged: projected gradient {norm} ≤ {bound}": "konvergiert: projizierter Gradient {norm} ≤ {bound}",
    "stopped after 1 iteration, as asked for": "wie verlangt nach 1 Iteration beendet",
    "stopped at the time limit, {seconds} s, as asked for": "wie verlangt an der Zeitgrenze beendet, {seconds} s",
    "stopped after {count} iterations, as asked for": "wie verlangt nach {count} Iterationen beendet",
    "circle = {energy:g}": "Kreis = {energy:g}",
    "floor = {energy:g}": "Schranke = {energy:g}",
    "iterate {index}, energy {energy:.4f}": "Iteration {index}, Energie {energy:.4f}",
    "not proved": "nicht bewiesen",
    "paused at {where}": "angehalten bei {where}",
    "starting": "beginnt",
    "stopped after {count} iterations": "nach {count} Iterationen beendet",
    "with itself": "mit sich selbst",
    "{deformer} moves its points": "{deformer} verschiebt die Punkte",
    "{ended}, {more}": "{ended}, {more}",
    "{names}: proving and writing keys   |   Esc: put all back": (
        "{names}: Schlüssel werden bewiesen und geschrieben   |   Esc: alles zurücksetzen"
    ),
    "{names}: waiting for the render": "{names}: wartet auf das Rendern",
    "{names}: {where}   |   Enter: keep this shape   |   Esc: put all back": (
        "{names}: {where}   |   Enter: diese Form behalten   |   Esc: alles zurücksetzen"
    ),
    "{reason} during the relaxation; nothing was written": (
        "{reason}, während entspannt wurde; nichts wurde geschrieben"
    ),
    "{reason}; the relaxation has ended": "{reason}; die Entspannung ist beendet",
}

_REPORTS = {
    "NOT proved free of contact everywhere": "NICHT überall als berührungsfrei bewiesen",
    "The bounding box": "Der Begrenzungsrahmen",
    "The curves were turned": "Die Kurven wurden gedreht",
    "The length": "Die Länge",
    "The radius": "Der Radius",
    "The scene plays frames {start} to {end} only, the animation has {first} to {last}: {helps}": (
        "Die Szene spielt nur die Bilder {start} bis {end}, die Animation hat {first} bis {last}: {helps}"
    ),
    "The tube of {names} is round: profiles and tapers are left out": (
        "Die Röhre von {names} ist rund: Profile und Verjüngungen sind weggelassen"
    ),
    "at a minimum, no small motion lowers the energy": "in einem Minimum, keine kleine Bewegung senkt die Energie",
    "at a saddle, one way leads down; press Leave Saddle": (
        "auf einem Sattel, ein Weg führt hinab; Sattel verlassen drücken"
    ),
    "at a saddle, {count} independent ways lead down; press Leave Saddle": (
        "auf einem Sattel, {count} unabhängige Wege führen hinab; Sattel verlassen drücken"
    ),
    "no scene plays negative frames, so bake again with a later Start Frame": (
        "keine Szene spielt negative Bilder, daher mit späterem Startbild erneut backen"
    ),
    "not at rest yet; press Continue first": "noch nicht in Ruhe; zuerst Fortsetzen drücken",
    "press Set Scene Range to see all of it": "Szenenbereich setzen drücken, um alles zu sehen",
    "proved free of contact with itself": "bewiesen berührungsfrei mit sich selbst",
    "proved free of contact with themselves and each other": (
        "bewiesen berührungsfrei mit sich selbst und untereinander"
    ),
    "{done}, proved free of contact": "{done}, bewiesen berührungsfrei",
    "{done}. {hidden}": "{done}. {hidden}",
    "{done}; 1 motion between keys is NOT proved free of contact": (
        "{done}; 1 Bewegung zwischen Schlüsseln ist NICHT als berührungsfrei bewiesen"
    ),
    "{done}; {count} motions between keys are NOT proved free of contact": (
        "{done}; {count} Bewegungen zwischen Schlüsseln sind NICHT als berührungsfrei bewiesen"
    ),
    "{made}, where strands are only {gap} apart": "{made}, wo Stränge nur {gap} voneinander entfernt sind",
    "{made}; NOT proved to be the same knot, so give it more Points": (
        "{made}; NICHT als derselbe Knoten bewiesen, daher mehr Punkte wählen"
    ),
    "{made}; the same knot, proved": "{made}; bewiesen derselbe Knoten",
    "{measure} of {names} stays at all {count} keys": "{measure} von {names} bleibt an allen {count} Schlüsseln gleich",
    "{names} {outcome}; {count} keys up to frame {frame:g}, {proof}": (
        "{names}: {outcome}; {count} Schlüssel bis Bild {frame:g}, {proof}"
    ),
    "{names} {outcome}; 1 new key up to frame {frame:g}, {proof}": (
        "{names}: {outcome}; 1 neuer Schlüssel bis Bild {frame:g}, {proof}"
    ),
    "{names} {outcome}; {count} new keys up to frame {frame:g}, {proof}": (
        "{names}: {outcome}; {count} neue Schlüssel bis Bild {frame:g}, {proof}"
    ),
    "{names} {outcome}; {proof}": "{names}: {outcome}; {proof}",
    "{names}: {count} points, at most {error} off": "{names}: {count} Punkte, höchstens {error} daneben",
    "{names}: {count} vertices": "{names}: {count} Punkte",
    "{names}: {count} vertices with {keys} shape keys": "{names}: {count} Punkte mit {keys} Formschlüsseln",
    "{names}: {rest}": "{names}: {rest}",
    "{proof}, before modifiers": "{proof}, vor Modifikatoren",
}

_SIDEBAR = {
    "'{name}' has a {kind} spline; it becomes a polygon of {points} points": (
        "'{name}' hat einen {kind}-Spline; er wird ein Polygon aus {points} Punkten"
    ),
    "'{name}' has {count} {kinds} splines; they become polygons of {points} points in all": (
        "'{name}' hat {count} Splines ({kinds}); sie werden Polygone aus insgesamt {points} Punkten"
    ),
    "1 crossing": "1 Kreuzung",
    "Add Knot": "Knoten hinzufügen",
    "Add {knot}": "{knot} hinzufügen",
    "By Name, as Woven": "Nach Name, wie geflochten",
    "Change Crossings (1 to {count})": "Kreuzungen ändern (1 bis {count})",
    "For more or fewer points change the curve's Resolution Preview U.": (
        "Für mehr oder weniger Punkte die Auflösung Vorschau U der Kurve ändern."
    ),
    "From Drawing": "Aus Zeichnung",
    "Keep {measure}": "{measure} beibehalten",
    "None": "Keine",
    "Quality: Custom, see Expert": "Qualität: benutzerdefiniert, siehe Experten",
    "Relax by Mobius Energy": "Nach Mobius-Energie entspannen",
    "Relax {count} Curves Together": "{count} Kurven gemeinsam entspannen",
    "Search...": "Suchen...",
    "one of {knots}": "einer von {knots}",
    "{count} crossings": "{count} Kreuzungen",
    "{count} more objects have smooth splines too": "{count} weitere Objekte haben auch glatte Splines",
    "{crossings}: it is not knotted": "{crossings}: nicht verknotet",
    "{crossings}: perhaps {knots}, not proved": "{crossings}: vielleicht {knots}, nicht bewiesen",
    "{crossings}: {knots}, proved": "{crossings}: {knots}, bewiesen",
    "{names} and {count} more": "{names} und {count} weitere",
    "{names} and {last}": "{names} und {last}",
    "{radius} (fitted)": "{radius} (angepasst)",
    "{radius} (your own)": "{radius} (eigener)",
}

SENTENCES = _REFUSALS | _ERRORS | _RUN | _REPORTS | _SIDEBAR | film.SENTENCES | pins.SENTENCES | surroundings.SENTENCES
