"""Separate: selected curves become ropes as thick as their bevels, keyed and proved as a relaxation is."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, stored
from mobius_flow import Relaxation
from mobius_flow.addon.scripting import begin, complete
from mobius_flow.core import MobiusFlowError

T = np.linspace(-6.0, 6.0, 13)[:, None]
X, Y = T * [1.0, 0, 0], T * [0, 1.0, 0]


def tube(points, depth, name):
    obj = add_curve([points], name, cyclic=False)
    obj.data.bevel_depth = depth
    return obj


def crossing():
    """Two selected tubes of radius 0.5 that run through each other, the second one scaled in the world."""
    first, second = tube(X, 0.5, "A"), tube(0.5 * Y, 0.25, "B")
    second.scale = (2, 2, 2)
    first.select_set(True)
    return first, second


def test_tubes_keep_clear_and_stay_as_thick():
    first, second = crossing()
    before = stored(first.data), stored(second.data)
    assert bpy.ops.curve.mobius_flow_separate(over="-Z") == {"FINISHED"}
    relaxation = Relaxation(first, second)
    one, other = relaxation.curves[-1].components
    assert one[6, 2] - other[6, 2] >= 1.0 - 1e-6
    np.testing.assert_allclose(np.stack([one, other])[:, [0, -1]], np.stack([X, Y])[:, [0, -1]], atol=1e-6)
    assert (first.data.bevel_depth, second.data.bevel_depth) == (0.5, 0.25)
    relaxation.clear()
    np.testing.assert_array_equal((stored(first.data), stored(second.data)), before)


def test_a_live_run_separates(operator):
    objects = crossing()
    operator.session = lambda _, values: begin(objects, values, False, False, ropes={"over": "z"})
    operator.start()
    operator.until(lambda: operator.run.state.over)
    assert "spline 1 of 'B' went over spline 1 of 'A'" in operator.run.message
    assert operator.run.report.certified


def test_the_time_limit_counts():
    session = begin(crossing(), complete({"time_limit": 5.0}) | {"avoid": ()}, ropes={"over": "z"})
    assert session.job.time_limit == 5.0


def test_a_script_says_where_it_is_tight_and_what_is_missing():
    first, second = crossing()
    first.data.bevel_depth = 8.0
    report = Relaxation(first, second).separate(length=10)
    assert "% of the radius only" in report.sentence
    assert report.outcome.place.vertices
    bare = add_curve([X + np.array([0, 0, 3.0])], "Bare", cyclic=False)
    with pytest.raises(MobiusFlowError, match="'Bare' has no bevel depth"):
        Relaxation(bare).separate()
