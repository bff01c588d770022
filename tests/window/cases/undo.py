"""Undo during a run, by key or from the menu, ends it and puts the curve back; so does redo."""

import bpy
from case import Steps, picture
from hands import here, key
from interruption import is_whole, over, relax, undo
from scene import points, reaches, ready


def case() -> Steps:
    yield from ready()
    before = points()
    yield from relax()
    yield from picture("undo-1-running")
    yield from key("Z", ctrl=True)
    yield from over("Ctrl-Z")
    is_whole(before)
    yield from picture("undo-2-ctrl-z", differs_from="undo-1-running")

    yield from relax()
    undo()
    yield from over("Edit > Undo")
    is_whole(before)

    with here():  # no new undo step, or there would be nothing to redo
        bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT")
    yield from reaches(2)
    with here():
        bpy.ops.ed.redo()
    yield from over("Edit > Redo")
    is_whole(before)

    yield from relax()
    with here():
        bpy.ops.ed.undo_push(message="Something else")
    yield from key("ESC")
    yield from over("Esc after another undo step")
    is_whole(before)
    yield from key("Z", ctrl=True)
    yield
    is_whole(before)
    yield from picture("undo-3-twice")
