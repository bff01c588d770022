"""Deleting the curve ends the run, and undo brings the whole curve back as it was before."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import here, key
from interruption import is_whole, over, relax, undo
from scene import obj, points, ready


def case() -> Steps:
    yield from ready()
    before = points()
    yield from relax()
    yield from key("X")
    yield from key("RETURN")  # Blender asks
    yield from over("X", "lost")
    assert not bpy.data.objects[:]
    yield from picture("deletion-1-deleted")
    yield from key("Z", ctrl=True)
    yield from until(lambda: obj() is not None, "Ctrl-Z to bring the curve back")
    is_whole(before)
    yield from picture("deletion-2-undone", differs_from="deletion-1-deleted")

    yield from relax()
    yield from key("ESC")
    yield from over("Esc after that")
    is_whole(before)

    yield from relax()
    bpy.data.objects.remove(obj())
    yield from over("removal by a script", "lost")
    assert np.array_equal([p.co[:] for p in bpy.data.curves["5_2"].splines[0].points], before)
    with here():
        bpy.ops.ed.undo_push(message="Removed")
    undo()
    yield from until(lambda: obj() is not None, "undo to bring the curve back")
    is_whole(before)

    yield from relax()
    bpy.data.curves.remove(obj().data)  # the object goes with it
    yield from over("removal of the data", "lost")
    with here():
        bpy.ops.ed.undo_push(message="Removed")
    undo()
    yield from until(lambda: obj() is not None, "undo to bring the curve back")
    is_whole(before)
    yield from picture("deletion-3-whole")
