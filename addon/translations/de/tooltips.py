"""Tooltips: of operators, of settings, and of what they let choose. Blender adds the full stop."""

from . import film, pins, surroundings
from .relaxation import RELAXATION

_OPERATORS = {
    "Add a knot or link as it is woven, to be relaxed: a name of the table, a torus knot, a braid or a hard unknot": (
        "Knoten oder Verschlingung hinzufügen, wie sie geflochten sind, zum Entspannen: ein Name aus der Tabelle, "
        "ein Torusknoten, ein Zopf oder ein schwerer Unknoten"
    ),
    "Add a knot or link made by a few numbers: a torus knot, braid, Lissajous curve, or two strands along a knot": (
        "Knoten oder Verschlingung aus wenigen Zahlen hinzufügen: Torusknoten, Zopf, Lissajous-Kurve oder "
        "zwei Stränge entlang eines Knotens"
    ),
    "Add a knot or link of the table, smooth, lying flat, with evenly spread strands; Relax lowers its energy": (
        "Knoten oder Verschlingung der Tabelle hinzufügen, glatt, flach liegend, mit gleichmäßig verteilten Strängen; "
        "Entspannen senkt ihre Energie"
    ),
    "Ask whether smooth splines may become polygons, then relax": (
        "Fragen, ob glatte Splines Polygone werden dürfen, dann entspannen"
    ),
    "Copy curves as they are shown now, without keys, modifiers that move points, and all else that moves them": (
        "Kurven kopieren, wie sie jetzt gezeigt werden, ohne Schlüssel, ohne Modifikatoren, die Punkte verschieben, "
        "und ohne alles andere, was sie bewegt"
    ),
    "Draw the selected curves as the thickest round tubes that do not touch. Relaxing keeps them so": (
        "Die ausgewählten Kurven als dickste runde Röhren zeichnen, die sich nicht berühren. "
        "Beim Entspannen bleiben sie es"
    ),
    "Give each spline of the selected objects a material of its own, in slots after those that are there": (
        "Jedem Spline der ausgewählten Objekte ein eigenes Material geben, in Slots nach den vorhandenen"
    ),
    "Give each of the selected objects curve data of its own; other objects keep what they share": (
        "Jedem ausgewählten Objekt eigene Kurvendaten geben; andere Objekte behalten, was sie teilen"
    ),
    "Go on downhill where the selected curves rest on a saddle of the energy; new keys follow the old ones": (
        "Weiter bergab gehen, wo die ausgewählten Kurven auf einem Sattel der Energie ruhen; "
        "neue Schlüssel folgen auf die alten"
    ),
    "Go on to the shape of the same energy that bends least for its length; new keys follow the old ones": (
        "Weiter zur Form gleicher Energie gehen, die sich für ihre Länge am wenigsten biegt; "
        "neue Schlüssel folgen auf die alten"
    ),
    "Keep all settings as a preset, or remove one": "Alle Einstellungen als Voreinstellung sichern oder eine entfernen",
    "Keep what the last relaxation had reached when it was cancelled": (
        "Behalten, was die letzte Entspannung erreicht hatte, als sie abgebrochen wurde"
    ),
    "Leave Edit Mode; what was edited is kept": "Den Bearbeitungsmodus verlassen; Bearbeitetes bleibt erhalten",
    "Let the points of the selected curves leave the plane": (
        "Den Punkten der ausgewählten Kurven erlauben, die Ebene zu verlassen"
    ),
    "Let the scene play all frames of the selected curves' animation, and no others": (
        "Die Szene alle Bilder der Animation der ausgewählten Kurven spielen lassen und keine anderen"
    ),
    "Make a knot of the selected flat drawing: where strands cross, one goes over the other; the drawing stays": (
        "Aus der ausgewählten flachen Zeichnung einen Knoten machen: wo sich Stränge kreuzen, "
        "geht einer über den anderen; die Zeichnung bleibt"
    ),
    "Make curves of the selected texts, and of meshes that are edges without faces; these stay as they are": (
        "Aus ausgewählten Texten und Meshes aus Kanten ohne Flächen Kurven machen; diese bleiben, wie sie sind"
    ),
    "Make meshes of the selected curves' tubes, with their keys as shape keys of the same vertices. glTF, USD and "
    "Alembic keep motion and colors (Alembic with Color Attributes on); FBX does with NLA Strips and All Actions off, "
    "one frame later": (
        "Meshes aus den Röhren der ausgewählten Kurven machen, mit ihren Schlüsseln als Formschlüsseln derselben "
        "Punkte. glTF, USD und Alembic behalten Bewegung und Farben (Alembic mit Farbeigenschaften); FBX ohne "
        "NLA-Streifen und Alle Aktionen, ein Bild später"
    ),
    "Make smooth splines of the selected curves as they are at the end of their animation, and say how far off they "
    "are. USD and Alembic keep the control points, glTF and FBX what is drawn (glTF nothing without a bevel)": (
        "Glatte Splines aus den ausgewählten Kurven am Ende ihrer Animation machen und sagen, wie weit sie daneben "
        "liegen. USD und Alembic behalten die Kontrollpunkte, glTF und FBX das Gezeichnete (glTF nichts ohne Fase)"
    ),
    "Make the selected curves of other files this file's own; their materials stay linked": (
        "Die ausgewählten Kurven anderer Dateien dieser Datei zu eigen machen; ihre Materialien bleiben verknüpft"
    ),
    "Pause the relaxation, or go on with it": "Die Entspannung anhalten oder fortsetzen",
    "Relax the selected curves anew from how they were before they were baked; new keys replace the old ones": (
        "Die ausgewählten Kurven neu entspannen, beginnend vor dem Backen; neue Schlüssel ersetzen die alten"
    ),
    "Relax the selected curves on from the end of their animation, with the points that they have, whatever Vertices "
    "says; new keys follow the old ones": (
        "Die ausgewählten Kurven vom Ende ihrer Animation an weiter entspannen, mit den Punkten, die sie haben, "
        "wie auch immer Punkte eingestellt ist; neue Schlüssel folgen auf die alten"
    ),
    "Relax the selected curves together, never through themselves or each other, and keep the motion as keyframes": (
        "Die ausgewählten Kurven gemeinsam entspannen, nie durch sich selbst oder einander hindurch, "
        "und die Bewegung als Schlüsselbilder behalten"
    ),
    "Replace Bézier and NURBS splines of the selected curves by the polygons drawn for them": (
        "Bézier- und NURBS-Splines der ausgewählten Kurven durch die Polygone ersetzen, die für sie gezeichnet werden"
    ),
    "Scale the selected curves at each of their keys, so that their size stays while they move": (
        "Die ausgewählten Kurven an jedem ihrer Schlüssel so skalieren, dass ihre Größe während der Bewegung bleibt"
    ),
    "Select the points that the message is about, in Edit Mode": (
        "Die Punkte auswählen, um die es in der Meldung geht, im Bearbeitungsmodus"
    ),
    "Set the options of this preset; options that it does not name get their defaults": (
        "Die Optionen dieser Voreinstellung setzen; nicht genannte erhalten ihre Standardwerte"
    ),
    "Stop here: keep the shape that the curves have now, and the motion up to it": (
        "Hier beenden: die jetzige Form der Kurven und die Bewegung bis dahin behalten"
    ),
    "Stop, and put everything back as it was; Recover brings it back again": (
        "Beenden und alles zurücksetzen, wie es war; Wiederherstellen holt es zurück"
    ),
    "Take the keys away and give the selected curves back as they were before they were baked": (
        "Die Schlüssel entfernen und die ausgewählten Kurven zurückgeben, wie sie vor dem Backen waren"
    ),
    "Tell whether the selected curves have come to rest at a minimum of the energy or at a saddle; nothing changes": (
        "Sagen, ob die ausgewählten Kurven in einem Minimum der Energie oder auf einem Sattel ruhen; nichts ändert sich"
    ),
    "Turn the selected curves so that the scene's camera sees their widest side": (
        "Die ausgewählten Kurven so drehen, dass die Kamera der Szene ihre breiteste Seite sieht"
    ),
    "Turn the selected curves so that they lie flat: the shape at the end of their animation extends least upwards": (
        "Die ausgewählten Kurven so drehen, dass sie flach liegen: die Form am Ende ihrer Animation ragt am "
        "wenigsten auf"
    ),
}

_KNOTS = {
    "A color for each spline": "Eine Farbe für jeden Spline",
    "A knot or link of the table": "Ein Knoten oder eine Verschlingung der Tabelle",
    "Add the mirror image": "Das Spiegelbild hinzufügen",
    "Crossings one by one: 2 crosses strands 2 and 3, -2 does so the other way": (
        "Kreuzungen eine nach der anderen: 2 kreuzt die Stränge 2 und 3, -2 tut es andersherum"
    ),
    "Full turns of the two strands around each other": "Volle Umdrehungen der beiden Stränge umeinander",
    "Give each spline of a link a material of its own": ("Jedem Spline einer Verschlingung ein eigenes Material geben"),
    "Half of the knot's width": "Die halbe Breite des Knotens",
    "Hide the curves that were drawn, in renders too": "Die gezeichneten Kurven verbergen, auch beim Rendern",
    "Hook the strands into each other the other way": "Die Stränge andersherum ineinanderhaken",
    "How far strands go over and under, 1 for as far as looks right in the room there": (
        "Wie weit Stränge darüber und darunter gehen, 1 für so weit, wie es zum Platz dort passt"
    ),
    "How often the curve goes round the torus": "Wie oft die Kurve um den Torus herumläuft",
    "How often the curve goes through the torus": "Wie oft die Kurve durch den Torus hindurchläuft",
    "Knot picked from the list": "Aus der Liste gewählter Knoten",
    "Knot that the strands follow": "Knoten, dem die Stränge folgen",
    "Knot to add": "Knoten zum Hinzufügen",
    "Knots that can be drawn with seven crossings or fewer": (
        "Knoten, die sich mit sieben oder weniger Kreuzungen zeichnen lassen"
    ),
    "Knots that need eight crossings": "Knoten, die acht Kreuzungen brauchen",
    "Knots that need nine crossings": "Knoten, die neun Kreuzungen brauchen",
    "Make the mirror image: every crossing changes over into under": (
        "Das Spiegelbild machen: an jeder Kreuzung wird aus darüber darunter"
    ),
    "Make the tube as thick as it can be without touching itself, rather than of a given Thickness": (
        "Die Röhre so dick machen, wie sie ohne Selbstberührung sein kann, statt mit gegebener Dicke"
    ),
    "Mark each crossing by an empty that shows its number": (
        "Jede Kreuzung mit einem Leerobjekt markieren, das ihre Nummer zeigt"
    ),
    "Name in the table, from 0_1 to 10_165, or of a link such as L2a1": (
        "Name in der Tabelle, von 0_1 bis 10_165, oder einer Verschlingung wie L2a1"
    ),
    "Name in the table, such as 3_1 or T(2,5)": "Name in der Tabelle, etwa 3_1 oder T(2,5)",
    "Number of crossings found": "Anzahl gefundener Kreuzungen",
    "Number of points, 0 for as many as look smooth": "Anzahl der Punkte, 0 für so viele, dass es glatt aussieht",
    "Number of strands along the knot": "Anzahl der Stränge entlang des Knotens",
    "Oscillations along X": "Schwingungen entlang X",
    "Oscillations along Y": "Schwingungen entlang Y",
    "Oscillations along Z": "Schwingungen entlang Z",
    "Radius of the tube; 0 for none. In a script, to give it turns Fit Tube off": (
        "Radius der Röhre; 0 für keine. In einem Skript schaltet seine Angabe Röhre anpassen aus"
    ),
    "Several closed curves that hang together": "Mehrere geschlossene Kurven, die zusammenhängen",
    "Steps from strand to strand around the knot; one curve if Strands has no common divisor with it": (
        "Schritte von Strang zu Strang um den Knoten herum; eine Kurve, wenn es keinen gemeinsamen Teiler mit Stränge "
        "gibt"
    ),
    "Strands along a knot, wound around each other": "Stränge entlang eines Knotens, umeinander gewunden",
    "Strands that cross one by one and close in a circle": (
        "Stränge, die sich einer nach dem anderen kreuzen und im Kreis schließen"
    ),
    "Swap over and under at a crossing; they are numbered along the curve": (
        "Darüber und darunter an einer Kreuzung vertauschen; sie sind entlang der Kurve nummeriert"
    ),
    "Swap over and under at all crossings": "Darüber und darunter an allen Kreuzungen vertauschen",
    "The first knots that need ten crossings": "Die ersten Knoten, die zehn Kreuzungen brauchen",
    "The other knots that need ten crossings": "Die übrigen Knoten, die zehn Kreuzungen brauchen",
    "The torus knot or link T(p, q)": "Der Torusknoten oder die Torusverschlingung T(p, q)",
    "Three oscillations at right angles": "Drei Schwingungen im rechten Winkel",
    "Two strands along a knot that hook into each other": "Zwei Stränge entlang eines Knotens, die ineinanderhaken",
    "What makes the knot": "Was den Knoten macht",
    "Where the oscillation along X begins": "Wo die Schwingung entlang X beginnt",
    "Where the oscillation along Y begins": "Wo die Schwingung entlang Y beginnt",
    "Which knots are shown": "Welche Knoten gezeigt werden",
    "Winds around a torus": "Windet sich um einen Torus",
}

_OUTPUTS = {
    "Control points beside the curve": "Kontrollpunkte neben der Kurve",
    "Hide the curve, which is in the same place, in views and renders": (
        "Die Kurve verbergen, die am selben Ort ist, in Ansichten und beim Rendern"
    ),
    "Number of points of each spline; 0: as few as the eye needs": (
        "Anzahl der Punkte jedes Splines; 0: so wenige, wie das Auge braucht"
    ),
    "Number of vertices round the tube": "Anzahl der Punkte rund um die Röhre",
    "Points on the curve, with handles": "Punkte auf der Kurve, mit Griffen",
    "Radius of the tubes; 0: as they are drawn, and where nothing is drawn as thick as fits": (
        "Radius der Röhren; 0: wie gezeichnet, und wo nichts gezeichnet ist, so dick, wie es passt"
    ),
    "Replace Bézier and NURBS splines by the polygons drawn for them": (
        "Bézier- und NURBS-Splines durch die Polygone ersetzen, die für sie gezeichnet werden"
    ),
    "The Möbius energy per length: yellow where there is much of it": (
        "Die Möbius-Energie pro Länge: gelb, wo viel davon ist"
    ),
    "The curve's own materials": "Die eigenen Materialien der Kurve",
    "The distance to the nearest other strand: yellow where it is near": (
        "Der Abstand zum nächsten anderen Strang: gelb, wo er nah ist"
    ),
    "What the splines are; both are the same curve": "Was die Splines sind; beide sind dieselbe Kurve",
    "What the vertices are colored by, as the curves are at the end of their animation": (
        "Wonach die Punkte gefärbt sind, mit den Kurven am Ende ihrer Animation"
    ),
}

_ANIMATION = {
    "Absolute shape keys and one F-curve on their evaluation time: small, fast, renders anywhere": (
        "Absolute Formschlüssel und eine F-Kurve auf ihrer Auswertungszeit: klein, schnell, rendert überall"
    ),
    "An F-curve for every coordinate of every point, for exporters that know no shape keys": (
        "Eine F-Kurve für jede Koordinate jedes Punktes, für Exporter, die keine Formschlüssel kennen"
    ),
    "As large as at the beginning": "So groß wie am Anfang",
    "As large as at the end": "So groß wie am Ende",
    "Draw the energy against the iterations in the 3D view": (
        "Die Energie über den Iterationen in der 3D-Ansicht zeichnen"
    ),
    "Every iterate gets the same number of frames; the length follows": (
        "Jede Iteration erhält gleich viele Bilder; die Länge folgt daraus"
    ),
    "Fit tubes again that were fitted before, at every key. A bevel of your own is not changed; "
    "in a script, to give this asks for it to be fitted": (
        "Röhren, die schon angepasst waren, an jedem Schlüssel neu anpassen. Eine eigene Fase wird nicht geändert; "
        "in einem Skript verlangt diese Angabe ihre Anpassung"
    ),
    "Frame at which the animation begins": "Bild, mit dem die Animation beginnt",
    "Frames at rest after the curves have moved": "Bilder in Ruhe, nachdem die Kurven sich bewegt haben",
    "Frames at rest before the curves move": "Bilder in Ruhe, bevor die Kurven sich bewegen",
    "Move the points to the relaxed curves, without animation": (
        "Die Punkte auf die entspannten Kurven setzen, ohne Animation"
    ),
    "Number of frames from one iterate to the next": "Anzahl der Bilder von einer Iteration zur nächsten",
    "Number of frames of the whole animation": "Anzahl der Bilder der ganzen Animation",
    "Show every so many iterates while relaxing; "
    "0: as often as leaves two thirds of the time to anything but drawing": (
        "Beim Entspannen jede so vielte Iteration zeigen; "
        "0: so oft, dass zwei Drittel der Zeit für anderes als Zeichnen bleiben"
    ),
    "The curves move about evenly over the whole length, and their last, small motions get some frames too": (
        "Die Kurven bewegen sich über die ganze Länge etwa gleichmäßig, "
        "und auch ihre letzten, kleinen Bewegungen erhalten einige Bilder"
    ),
    "The curves move by the same distance in every frame of the whole length": (
        "Die Kurven bewegen sich in jedem Bild der ganzen Länge gleich weit"
    ),
    "The length of the curves, which is what the relaxation itself keeps": (
        "Die Länge der Kurven, die beim Entspannen ohnehin bleibt"
    ),
    "The longest side of the box around the curves": "Die längste Seite des Rahmens um die Kurven",
    "The mean distance of the curves from their center (root mean square)": (
        "Der mittlere Abstand der Kurven von ihrer Mitte (quadratisches Mittel)"
    ),
    "The sizes of the steps add up evenly over the whole length: the time of a gradient flow": (
        "Die Schrittweiten summieren sich gleichmäßig über die ganze Länge: die Zeit eines Gradientenflusses"
    ),
    "Thin the animation out to this many keys, 0 for one key for every iterate; "
    "where the straight motion between keys is not proved free of contact, more are kept": (
        "Die Animation auf so viele Schlüssel ausdünnen, 0 für einen je Iteration; wo die gerade Bewegung zwischen "
        "Schlüsseln nicht als berührungsfrei bewiesen ist, bleiben mehr"
    ),
    "What passes evenly from frame to frame": "Was von Bild zu Bild gleichmäßig vergeht",
    "What stays": "Was bleibt",
    "What stays as it is at the beginning while the curves move; they are scaled for that": (
        "Was beim Bewegen der Kurven bleibt wie am Anfang; sie werden dafür skaliert"
    ),
    "What the animation is written as": "Als was die Animation geschrieben wird",
    "Which key has the size that all are given": "Welcher Schlüssel die Größe hat, die alle erhalten",
}

TOOLTIPS = (
    _OPERATORS | _KNOTS | _OUTPUTS | _ANIMATION | film.TOOLTIPS | pins.TOOLTIPS | surroundings.TOOLTIPS | RELAXATION
)
