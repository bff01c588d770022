"""Texts of the stage and of films, of all kinds."""

LABELS = {
    "As the Scene": "Wie die Szene",
    "File": "Datei",
    "Fine": "Fein",
    "Look": "Aussehen",
    "Overwrite": "Überschreiben",
    "Quick": "Schnell",
    "Remove Stage": "Bühne entfernen",
    "Render Film": "Film rendern",
    "Set Up Stage": "Bühne einrichten",
    "Use Camera": "Kamera verwenden",
    "Use World": "Welt verwenden",
}

TOOLTIPS = {
    "Ask whether a film that is there may be replaced, then render": (
        "Fragen, ob ein vorhandener Film ersetzt werden darf, dann rendern"
    ),
    "How the frames are rendered": "Wie die Bilder gerendert werden",
    "Plain shading by Workbench: many frames in little time": (
        "Schlichte Schattierung durch Workbench: viele Bilder in kurzer Zeit"
    ),
    "Put a camera, lights, a floor and a sky around the selected curves, for as long as they move. "
    "Your own lights stay; your camera and your world come back with Remove Stage": (
        "Kamera, Lichter, Boden und Himmel um die ausgewählten Kurven stellen, für die ganze Dauer ihrer Bewegung. "
        "Eigene Lichter bleiben; die eigene Kamera und Welt kommen mit Bühne entfernen zurück"
    ),
    "Render all frames that the scene plays to an MP4. Esc over the render's window cancels, and leaves no file": (
        "Alle Bilder, die die Szene spielt, in eine MP4-Datei rendern. Esc über dem Fenster des Renderns bricht ab "
        "und hinterlässt keine Datei"
    ),
    "Render through the stage's camera instead of your own": (
        "Durch die Kamera der Bühne statt durch die eigene rendern"
    ),
    "Render under the stage's sky instead of your own world": (
        "Unter dem Himmel der Bühne statt in der eigenen Welt rendern"
    ),
    "Replace a file that is there": "Eine vorhandene Datei ersetzen",
    "Soft light and shadows by Cycles: seconds or minutes for each frame": (
        "Weiches Licht und weiche Schatten durch Cycles: Sekunden oder Minuten je Bild"
    ),
    "Take the stage away, and use your own camera and world again": (
        "Die Bühne entfernen und wieder die eigene Kamera und Welt verwenden"
    ),
    "Where the film goes": "Wohin der Film kommt",
    "Where the film goes, an MP4; // is the directory of the open file": (
        "Wohin der Film kommt, als MP4; // ist das Verzeichnis der geöffneten Datei"
    ),
    "With the render engine and the settings that the scene has": (
        "Mit der Render-Engine und den Einstellungen der Szene"
    ),
}

SENTENCES = {
    "A film of {count} frames: {path}": "Ein Film mit {count} Bildern: {path}",
    "Blender is rendering; wait until it is done, or stop it with Esc": (
        "Blender rendert gerade; das Ende abwarten oder mit Esc abbrechen"
    ),
    "End": "Ende",
    "Frame Start": "Bild Anfang",
    "Frames are {width} × {height} pixels, but films want even numbers of them": (
        "Die Bilder haben {width} × {height} Pixel, Filme verlangen aber gerade Anzahlen"
    ),
    "Overwrite the film?": "Den Film überschreiben?",
    "Renders do not show {names}, as there is no tube: press Fit Tube": (
        "Gerenderte Bilder zeigen {names} nicht, da eine Röhre fehlt: Röhre anpassen drücken"
    ),
    "Resolution X": "Auflösung X",
    "Save your file first, since the film is to lie beside it, or choose another place": (
        "Zuerst die eigene Datei speichern, da der Film neben ihr liegen soll, oder einen anderen Ort wählen"
    ),
    "The film has no name; give it a file": "Der Film hat keinen Namen; eine Datei angeben",
    "The film was not rendered to its end; no file was written": (
        "Der Film wurde nicht zu Ende gerendert; es wurde keine Datei geschrieben"
    ),
    "The picture has another shape than the stage's camera; press Set Up Stage again": (
        "Das Bild hat ein anderes Seitenverhältnis als die Kamera der Bühne; erneut Bühne einrichten drücken"
    ),
    "The scene has no camera; press Set Up Stage first": (
        "Die Szene hat keine Kamera; zuerst Bühne einrichten drücken"
    ),
    "The scene has no camera; press Set Up Stage first, or add one": (
        "Die Szene hat keine Kamera; zuerst Bühne einrichten drücken oder eine hinzufügen"
    ),
    "The scene has no stage; press Set Up Stage first": "Die Szene hat keine Bühne; zuerst Bühne einrichten drücken",
    "{name} does not end in {suffix}, as films do here; give it another name": (
        "{name} endet nicht auf {suffix}, wie es Filme hier tun; einen anderen Namen wählen"
    ),
    "{name} is there already": "{name} ist schon vorhanden",
    "{path} cannot be written; choose another place for the film": (
        "{path} kann nicht geschrieben werden; einen anderen Ort für den Film wählen"
    ),
    "{path} is a directory; name a file in it": "{path} ist ein Verzeichnis; eine Datei darin angeben",
    "{path} is no directory; choose another place for the film": (
        "{path} ist kein Verzeichnis; einen anderen Ort für den Film wählen"
    ),
    "{path} is there already; give the film another name, or let it be overwritten": (
        "{path} ist schon vorhanden; dem Film einen anderen Namen geben oder ihn überschreiben lassen"
    ),
    "{path}: Blender did not render the film to its end; is the disk full?": (
        "{path}: Blender hat den Film nicht zu Ende gerendert; ist der Datenträger voll?"
    ),
}
