"""Blender in German: the panel, the reasons for refusals, the status bar and reports are, and change back at once."""

import bpy
from case import Steps, picture
from hands import addon, button, here, key
from scene import is_, obj, reaches, ready

LANGUAGE = "de_DE"


def case() -> Steps:
    yield from ready(vertices=1200)
    view = bpy.context.preferences.view
    relax = bpy.ops.curve.mobius_flow_relax.get_rna_type()
    assert translated("Links") == "Links", "English to begin with"
    view.language = LANGUAGE  # an error here: this Debian was made without German; remove it, and it is made anew
    view.use_translate_interface = view.use_translate_tooltips = view.use_translate_reports = True
    assert translated("Relax") == "Entspannen"
    assert bpy.app.translations.pgettext_tip(relax.description).startswith("Die ausgewählten Kurven gemeinsam")
    assert translated("Links") == "Verschlingungen", "and not hyperlinks"
    yield from picture("german-1-ready")

    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    yield from picture("german-2-running", differs_from="german-1-ready")
    line = addon("live.modal").status_line(addon("live.registry").current())
    assert "Enter: diese Form behalten" in line, line
    yield from key("RETURN")
    yield from is_("done")
    report = addon("translations").rpt_(addon("live.registry").latest().message)
    assert "Schritten beendet; " in report, report
    assert report.endswith("bewiesen berührungsfrei mit sich selbst"), report
    yield from picture("german-3-kept")

    obj().data.shape_keys.key_blocks[1].data[0].co.x += 1.0
    yield from button("curve.mobius_flow_continue")
    yield from picture("german-4-refused", differs_from="german-3-kept")
    with here():
        bpy.ops.mesh.primitive_cube_add()
    yield from picture("german-5-no-curve")
    view.use_translate_interface = False
    assert translated("Relax") == "Relax"
    yield from picture("german-6-english")


def translated(text: str) -> str:
    """What Blender makes of one of our names."""
    return str(bpy.app.translations.pgettext_iface(text, addon("translations").CONTEXT))
