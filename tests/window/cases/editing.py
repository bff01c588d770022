"""Opening the curve for editing puts it back first; points added by somebody else are left alone, and can be undone."""

import bpy
from case import Steps, picture, until
from hands import here, key
from interruption import is_whole, over, relax, undo
from scene import obj, points, ready


def case() -> Steps:
    yield from ready()
    before = points()
    yield from relax()
    yield from key("TAB")
    yield from over("Tab", "lost")
    assert bpy.context.mode == "EDIT_CURVE"
    yield from picture("editing-1-edit-mode")
    yield from key("TAB")
    yield from until(lambda: bpy.context.mode == "OBJECT", "object mode")
    is_whole(before)
    yield from key("Z", ctrl=True)
    yield
    with here():
        bpy.ops.object.mode_set(mode="OBJECT")
    is_whole(before)

    yield from relax()
    count = len(points())
    obj().data.splines[0].points.add(1)
    yield from over("a new point", "lost")
    assert len(points()) == count + 1, "what somebody made is left alone"
    yield from picture("editing-2-new-point")
    undo()
    yield
    is_whole(before)
    yield from picture("editing-3-undone")
