"""Texts of the surroundings of curves, of all kinds."""

LABELS = {
    "Add to Avoid": "Meiden",
    "Avoid": "Meiden",
    "Surroundings": "Umgebung",
}

SENTENCES = {
    "'{collection}' has {names} now": "'{collection}' enthält nun {names}",
    "'{name}' is hidden; show it first, or leave it out": "'{name}' ist verborgen; zuerst einblenden oder weglassen",
    "'{name}' is linked from another file; choose another collection to avoid": (
        "'{name}' ist aus einer anderen Datei verknüpft; eine andere Sammlung zum Meiden wählen"
    ),
    "'{name}' is moved by {mover}, and curves that avoid something must keep their places; "
    "remove that, or avoid nothing": (
        "'{name}' wird bewegt ({mover}), aber Kurven, die etwas meiden, müssen an ihrem Ort bleiben; "
        "das entfernen oder nichts meiden"
    ),
    "'{name}' is moved by {mover}, and what is avoided must stand still; "
    "remove that, or leave it out of what is avoided": (
        "'{name}' wird bewegt ({mover}), aber was gemieden wird, muss stillstehen; das entfernen oder nicht meiden"
    ),
    "'{name}' is of type {type}, which cannot be avoided; convert it to a mesh, or leave it out": (
        "'{name}' ist vom Typ {type}, der nicht gemieden werden kann; in ein Mesh konvertieren oder weglassen"
    ),
    "'{name}' shows a {type} too, which cannot be avoided; convert it to a mesh, or leave it out": (
        "'{name}' zeigt auch etwas vom Typ {type}, das nicht zu meiden ist; in ein Mesh konvertieren oder weglassen"
    ),
    "'{name}' shows neither faces nor edges; leave it out of what is avoided": (
        "'{name}' zeigt weder Flächen noch Kanten; nicht meiden"
    ),
    "A point of '{name}' is not finite, or further away than anything; repair or delete it": (
        "Ein Punkt von '{name}' ist nicht endlich oder unermesslich weit weg; reparieren oder löschen"
    ),
    "Avoided": "Gemieden",
    "Balance does not go with what is avoided; leave it out, or avoid nothing": (
        "Ausgleichen geht nicht, wo etwas gemieden wird; eines von beiden weglassen"
    ),
    "Curves never touch {names}": "Kurven berühren nie {names}",
    "Nothing in it is visible": "Nichts darin ist sichtbar",
    "Nothing is near the selected curves but what they avoid": (
        "In der Nähe der ausgewählten Kurven ist nichts, was sie nicht meiden"
    ),
    "Only the length can be kept where something is pinned or avoided; set Keep to Length": (
        "Wo etwas gepinnt ist oder gemieden wird, kann nur die Länge beibehalten werden; Behalten auf Länge stellen"
    ),
    "There is no collection '{name}' to avoid": "Es gibt keine Sammlung '{name}', die gemieden werden könnte",
    "an object that its shape is made with": "Objekt, mit dem seine Form gemacht ist",
    "animation of its shape": "Animation seiner Form",
    "the modifier '{modifier}'": "Modifikator '{modifier}'",
    "the relaxation itself": "die Entspannung selbst",
    "{names} nearby are neither selected nor avoided, and may be crossed": (
        "{names} in der Nähe sind weder ausgewählt noch gemieden und werden vielleicht durchquert"
    ),
    "{names} nearby is neither selected nor avoided, and may be crossed": (
        "{names} in der Nähe ist weder ausgewählt noch gemieden und wird vielleicht durchquert"
    ),
    "{proof}, and with {avoided}": "{proof} und mit {avoided}",
}

TOOLTIPS = {
    "Collection whose visible objects are never touched by curves that are relaxed": (
        "Sammlung, deren sichtbare Objekte von Kurven, die entspannt werden, nie berührt werden"
    ),
    "Let relaxed curves never touch what is near them now: put it into the collection Avoid, besides those it is in": (
        "Entspannte Kurven nie berühren lassen, was jetzt in ihrer Nähe ist: es auch in die Sammlung zum Meiden legen"
    ),
    "Name of the collection whose visible objects are never touched; empty for none": (
        "Name der Sammlung, deren sichtbare Objekte nie berührt werden; leer für keine"
    ),
}
