"""What is refused is mended by the button below the sentence, step by step, and each step is undone by one Ctrl-Z."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key
from scene import is_, obj, points, ready


def case() -> Steps:
    yield from ready()
    knot = obj()
    other = bpy.data.objects.new("Other", knot.data)
    bpy.context.scene.collection.objects.link(other)
    hook = knot.modifiers.new("Bend", "SIMPLE_DEFORM")
    hook.deform_method, hook.angle = "TWIST", 0.5
    before = points()
    with here():
        bpy.ops.ed.undo_push(message="Hindered")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.ed.undo_push(message="Edited")

    for name, wanted in (
        ("object_mode", "shares its curve data"),
        ("single_user", "moves its points"),
    ):
        yield from picture(f"mending-{name}")
        yield from pressed(name, wanted)
    assert obj().data != bpy.data.objects["Other"].data
    assert np.array_equal(points(), before)
    yield from picture("mending-copy")
    yield from pressed("copy", "")
    assert np.abs(points() - before).max() > 1e-3, "the copy has the shape that was shown"
    assert not obj().modifiers
    yield from picture("mending-done")
    yield from button("curve.mobius_flow_relax")
    yield from is_("running")
    yield from key("ESC")
    yield from is_("cancelled")


def pressed(name: str, wanted: str) -> Steps:
    """Press a button, undo it, press it again, and see what is refused next."""
    hindered = said()
    yield from button("curve.mobius_flow_mend")
    yield from until(lambda: said() != hindered, f"{name} to help")
    yield from key("Z", ctrl=True)
    yield from until(lambda: said() == hindered, f"{name} to be undone")
    yield from button("curve.mobius_flow_mend")
    yield from until(lambda: said() != hindered, f"{name} to help again")
    assert wanted in said(), said()


def said() -> str:
    """What is refused now."""
    with here():
        refusal = addon("live.requirements").RELAXABLE(bpy.context)
    return refusal.sentence if refusal else ""
