"""A file saved while keys are written holds all of them, and the run is one undo step all the same."""

import os

import bpy
import numpy as np
from case import Steps, until
from hands import addon, here, key
from interruption import over, relax
from scene import obj, points, ready

FILE = os.path.join(os.environ["ROOM"], "saved.blend")


def case() -> Steps:
    addon("live.run").KeyWriter.slice = 0.0  # a key at a tick
    yield from ready()
    before = points()
    yield from relax()
    yield from key("RETURN")
    yield from until(lambda: obj().data.shape_keys is not None, "keys to be written")
    some = len(obj().data.shape_keys.key_blocks)
    with here():
        bpy.ops.wm.save_as_mainfile(filepath=FILE, copy=True)
    yield from over("saving", "done")
    every = len(obj().data.shape_keys.key_blocks)
    assert some < every, "saved in the middle"
    yield from key("Z", ctrl=True)
    yield from until(lambda: len(points()) == len(before), "undo")
    assert np.array_equal(points(), before)
    assert obj().data.shape_keys is None

    with here():
        bpy.ops.wm.open_mainfile(filepath=FILE, load_ui=False)
    yield
    assert len(obj().data.shape_keys.key_blocks) == every
    with here():
        assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert np.array_equal(points(), before)
