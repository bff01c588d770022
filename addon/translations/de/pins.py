"""Texts of pins and of open splines, of all kinds."""

LABELS = {
    "Close Splines": "Splines schließen",
    "Pin Ends": "Enden pinnen",
    "Pin Selected Points": "Ausgewählte Punkte pinnen",
    "Pin Tangents": "Tangenten pinnen",
    "Pins": "Pins",
    "Unpin": "Lösen",
}

TOOLTIPS = {
    "Join the two ends of every open spline of the selected curves": (
        "Die beiden Enden jedes offenen Splines der ausgewählten Kurven verbinden"
    ),
    "Let pinned points move again: the selected ones in Edit Mode, and all of the selected curves in Object Mode": (
        "Gepinnte Punkte wieder bewegen lassen: im Bearbeitungsmodus die ausgewählten, "
        "im Objektmodus alle der ausgewählten Kurven"
    ),
    "Pin both ends of every open spline of the selected curves, so that no knot slips off": (
        "Beide Enden jedes offenen Splines der ausgewählten Kurven pinnen, damit kein Knoten abrutscht"
    ),
    "Pin the neighbours that pinned vertices have in the refined start too, and so the curve's direction there": (
        "Auch die Nachbarn festhalten, die gepinnte Punkte am verfeinerten Anfang haben, "
        "und so die Richtung der Kurve dort"
    ),
    "Pin the selected points: they stay exactly where they are while the curve is relaxed": (
        "Die ausgewählten Punkte pinnen: Sie bleiben genau, wo sie sind, während die Kurve entspannt wird"
    ),
}

SENTENCES = {
    "All splines are closed and have no ends; select an open one": (
        "Alle Splines sind geschlossen und haben keine Enden; einen offenen auswählen"
    ),
    "Go to Edit Mode and select the points to pin": (
        "In den Bearbeitungsmodus gehen und die Punkte auswählen, die gepinnt werden sollen"
    ),
    "No points are selected; select some to pin": "Es sind keine Punkte ausgewählt; welche zum Pinnen auswählen",
    "No points of the selected curves are pinned": "Kein Punkt der ausgewählten Kurven ist gepinnt",
    "No selected curve has an open spline without keys; select one in Object Mode": (
        "Keine ausgewählte Kurve hat einen offenen Spline ohne Schlüssel; eine im Objektmodus auswählen"
    ),
    "Points that are pinned: {count}": "Gepinnte Punkte: {count}",
    "Scaling would move pinned points; unpin them first": ("Skalieren würde gepinnte Punkte bewegen; sie zuerst lösen"),
    "Spline {number} of '{name}' is a {kind} spline, of which only the ends can be pinned; "
    "convert it to Poly first (Edit Mode, Curve > Set Spline Type > Poly)": (
        "Spline {number} von '{name}' ist ein {kind}-Spline, von dem nur die Enden gepinnt werden können; "
        "zuerst in Poly umwandeln (Bearbeitungsmodus, Kurve > Splinetyp setzen > Poly)"
    ),
    "Splines of '{name}' were changed": "Splines von '{name}' wurden geändert",
    "straight = {energy:g}": "gerade = {energy:g}",
    "{count} points pinned": "{count} Punkte gepinnt",
    "{pinned}; Continue minds that, Bake Again begins with {names} as pinned before": (
        "{pinned}; Fortsetzen beachtet das, Erneut backen beginnt mit {names}, wie zuvor gepinnt"
    ),
}
