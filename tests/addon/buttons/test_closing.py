"""Open splines are closed where nothing depends on their being open."""

from functools import partial

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, contents, relax, stored
from mended_curves import SHAPE, two

CLOSE = partial(bpy.ops.curve.mobius_flow_mend, remedy="CLOSE")


def refused(why):
    before = contents()
    with pytest.raises(RuntimeError, match=why):
        CLOSE()
    assert contents() == before


def test_open_splines_are_closed():
    first, second = two(cyclic=False)
    third = add_curve([SHAPE + 20], "C")
    second.data.splines.new("NURBS").points.add(5)
    before = [stored(obj.data) for obj in (first, second, third)]
    assert CLOSE() == {"FINISHED"}
    assert all(spline.use_cyclic_u for obj in (first, second) for spline in obj.data.splines)
    for obj, points in zip((first, second, third), before, strict=True):
        np.testing.assert_array_equal(stored(obj.data), points)


def test_what_is_closed_or_baked_stays():
    """Keys of an open spline are proved for an open one."""
    add_curve([SHAPE])
    refused("Nothing selected needs that")
    add_curve([SHAPE + 9], cyclic=False)
    relax(max_iterations=1)
    refused("Nothing selected needs that")
