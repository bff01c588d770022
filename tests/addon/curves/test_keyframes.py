"""Blender shows at every key frame exactly what was keyed; other animation is left alone."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from blender_scenes import add_hopf_link, add_trefoil, evaluated, fcurves, relax, stored
from mobius_flow.addon.curves import bake
from mobius_flow.addon.curves.keyframes import write
from mobius_flow.addon.curves.moving import what_moves
from mobius_flow.core import Curve, RelaxOptions
from mobius_flow.core import relax as iterates_of
from mobius_flow.core.keys.recording import Key, Keys


def library_frames(obj, **options):
    """The library's iterates for an object at the origin, as 32-bit floats."""
    splits = np.cumsum([len(spline.points) for spline in obj.data.splines])[:-1]
    components = np.split(stored(obj.data).astype(np.float64), splits)
    iterates = iterates_of(Curve.from_components(components), RelaxOptions(radius="none", **options))
    return [iterate.curve.vertices.astype(np.float32) for iterate in iterates]


@pytest.mark.parametrize("add", [add_trefoil, add_hopf_link])
def test_iterates_are_exact_at_their_frames_and_straight_in_between(add):
    obj = add()
    expected = library_frames(obj, max_iterations=8)
    relax(max_iterations=8, start_frame=11, frames_per_iterate=2.5)
    for k, points in enumerate(expected):
        np.testing.assert_array_equal(evaluated(obj, 11 + 2.5 * k), points)
    for frame, points in ((-5, expected[0]), (100, expected[-1])):
        np.testing.assert_array_equal(evaluated(obj, frame), points)
    frames = [point.co[0] for point in fcurves(obj.data.shape_keys)[0].keyframe_points]
    for start, end in pairwise(frames[2:5]):
        ends = evaluated(obj, start).astype(np.float64), evaluated(obj, end).astype(np.float64)
        for share in (0.25, 0.75):
            straight = (1 - share) * ends[0] + share * ends[1]
            np.testing.assert_allclose(evaluated(obj, start + (end - start) * share), straight, atol=2e-6)


def test_many_keys_stay_exact():
    obj = add_trefoil(12)
    points = np.random.default_rng(1).standard_normal((600, 12, 3)).astype(np.float32)
    keys = Keys(tuple(Key(0.37 * k, p) for k, p in enumerate(points)), 0)
    write(obj, keys, np.arange(-20.0, 580.0))
    for k in (0, 1, 2, 299, 500, 598, 599):
        np.testing.assert_allclose(evaluated(obj, k - 20), points[k], atol=2e-4 if 0 < k < 599 else 0)


def relax_trefoil(**options):
    add_trefoil()
    return relax(max_iterations=5, **options)


def test_the_result_alone_has_no_keys():
    obj = relax_trefoil(keyframes="RESULT")
    assert obj.data.shape_keys is obj.data.animation_data is None
    assert not bpy.data.actions


# -- since 4.4 Blender puts keys of an object into the action of its curve ---------------------------------------------


@pytest.fixture
def turning():
    """A baked curve on an object that turns."""
    add_trefoil()
    obj = relax(max_iterations=3)
    for frame, turn in ((1, 0.0), (100, 2.0)):
        obj.rotation_euler.z = turn
        obj.keyframe_insert("rotation_euler", frame=frame)
    assert bake.is_baked(obj.data)
    assert what_moves(obj) == "animation"
    return obj


def angle(frame):
    bpy.context.scene.frame_set(frame)
    return bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get()).rotation_euler.z


@pytest.mark.parametrize("operator", ["bake_again", "continue", None])
def test_a_turning_object_goes_on_turning_whatever_happens_to_its_curve(turning, operator):
    for _ in range(2 if operator else 0):
        done = getattr(bpy.ops.curve, f"mobius_flow_{operator}")(max_iterations=2, fit_bevel=False)
        assert done == {"FINISHED"}
        assert bake.is_baked(turning.data)
        assert angle(100) == pytest.approx(2.0)
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert angle(100) == pytest.approx(2.0)
    assert len(turning.data.splines[0].points) == 30
    (action,) = bpy.data.actions
    assert all(slot.target_id_type == "OBJECT" for slot in getattr(action, "slots", ()))
    before = stored(turning.data)
    bpy.context.scene.frame_set(1)
    np.testing.assert_array_equal(stored(turning.data), before)
