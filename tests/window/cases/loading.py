"""Loading a file or making a new one ends the run."""

import os

import bpy
from case import Steps, picture
from interruption import is_whole, over, relax
from scene import obj, points, ready

FILE = os.path.join(os.environ["ROOM"], "loaded.blend")


def case() -> Steps:
    yield from ready()
    before = points()
    bpy.ops.wm.save_as_mainfile(filepath=FILE)
    yield from relax()
    bpy.ops.wm.open_mainfile(filepath=FILE)
    yield from over("opening a file", "none")
    yield
    is_whole(before)
    yield from picture("loading-1-opened")

    yield from relax()
    bpy.ops.wm.revert_mainfile()
    yield from over("going back to the saved file", "none")
    yield
    is_whole(before)

    yield from relax()
    bpy.ops.wm.read_homefile(app_template="")
    yield from over("a new file", "none")
    yield
    assert obj().name == "Cube"
    yield from picture("loading-2-new")
