"""New names, another frame and saving do not disturb a run; what is saved is the curve as it was."""

import os
import shutil

import bpy
import numpy as np
from case import Steps, picture
from hands import key, window
from interruption import is_whole, over, relax
from scene import obj, points, reaches, ready, run

FILE = os.path.join(os.environ["ROOM"], "saved.blend")
COPY = os.path.join(os.environ["ROOM"], "copy.blend")


def case() -> Steps:
    yield from ready()
    before = points()
    yield from relax()
    obj().name, obj().data.name = "Renamed", "Renamed too"
    window().scene.frame_set(7)
    yield from reaches(run().last.index + 2)
    assert run().name == "'Renamed'"

    shown = points()
    bpy.ops.wm.save_as_mainfile(filepath=FILE)
    assert np.array_equal(points(), shown), "saving does not disturb what is shown"
    assert np.array_equal(saved(), before), "what is saved is the curve as it was"
    yield from reaches(run().last.index + 2)
    yield from picture("naming-1-running")
    yield from key("ESC")
    yield from over("Esc after new names, another frame and saving")
    is_whole(before)
    assert (obj().name, obj().data.name, window().scene.frame_current) == ("Renamed", "Renamed too", 7)
    yield from picture("naming-2-restored", differs_from="naming-1-running")


def saved() -> np.ndarray:
    """The points of the curve in the file."""
    shutil.copy(FILE, COPY)  # Blender does not load from the file that is open
    with bpy.data.libraries.load(COPY) as (_, loaded):
        loaded.curves = ["Renamed too"]
    (data,) = loaded.curves
    coordinates = np.array([p.co[:] for p in data.splines[0].points], dtype=np.float32)
    bpy.data.curves.remove(data)
    return coordinates
