"""Open splines, and points that are pinned."""

import bpy
import numpy as np
import pytest
from baked_curves import SHORT, go_on, reopen
from blender_scenes import add_curve, contents, evaluated, place, relax, stored
from mobius_flow import Relaxation
from mobius_flow.addon.curves import pins
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core import MobiusFlowError
from mobius_flow.core.knots import overhand
from shapes import regular_polygon

ARC = overhand(60).vertices.astype(np.float32)
PIN, UNPIN = bpy.ops.curve.mobius_flow_pin, bpy.ops.curve.mobius_flow_unpin


def add_arc(**options):
    return add_curve([ARC], cyclic=False, **options)


def select(obj, *indices):
    """Go to Edit Mode and select points of the first spline."""
    if obj.mode != "EDIT":
        bpy.ops.object.mode_set(mode="EDIT")
    for k, point in enumerate(obj.data.splines[0].points):
        point.select = k in indices


def pin(obj, *indices):
    select(obj, *indices)
    assert PIN() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")


def held(obj):
    return np.flatnonzero(pins.marked(obj.data.splines[0])).tolist()


def still(obj, points, atol=0.0):
    """See that points are at every key where they should be, in the very numbers."""
    frames = np.stack(BakedKeys([obj]).frames)
    for point in points:
        distance = np.linalg.norm(frames - point, axis=2)
        (index,) = np.flatnonzero((distance <= atol).all(axis=0))
        assert len(np.unique(frames[:, index], axis=0)) == 1
    assert not np.array_equal(frames[0], frames[-1])


def test_selected_points_are_pinned_and_let_go(capfd):
    obj = add_arc()
    pin(obj, 0, 7)
    assert held(obj) == [0, 7]
    assert "Pinned points: 2" in capfd.readouterr().out
    select(obj, 7, 8)
    assert UNPIN() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert held(obj) == [0]
    np.testing.assert_array_equal(pins.places(obj.data), ARC[:1])
    assert UNPIN() == {"FINISHED"}
    assert held(obj) == []


@pytest.mark.parametrize("where", ["origin", "placed", "far"])
def test_they_do_not_move_at_all(where):
    """Far from the object's origin they are rounded when they are mapped into the world and back."""
    obj = add_arc()
    if where == "placed":
        place(obj)
    elif where == "far":
        obj.location, obj.rotation_euler, obj.scale = (3e3, -2e3, 1e3), (0.3, 0.2, 0.1), (0.1, 0.1, 0.1)
    pin(obj, 0, 30, 59)
    relax(max_iterations=8)
    still(obj, ARC[[0, 30, 59]], atol=1e-4 if where == "far" else 0.0)
    assert BakedKeys([obj]).unproved == 0


def test_tangents():
    obj = add_arc()
    assert PIN() == {"FINISHED"}
    assert held(obj) == [0, 59]
    relax(max_iterations=8, pin_tangents=True)
    still(obj, ARC[[0, 59]])
    frames = np.stack(BakedKeys([obj]).frames)
    for edge in (frames[:, 1] - frames[:, 0], frames[:, -1] - frames[:, -2]):
        np.testing.assert_array_equal(edge, np.broadcast_to(edge[0], edge.shape))
    assert bpy.context.scene.mobius_flow.pin_tangents is False


def test_they_are_the_points_own_in_copies_files_and_edit_mode(tmp_path):
    obj = add_arc()
    pin(obj, 10, 59)
    copy = obj.copy()
    copy.data = obj.data.copy()
    assert held(copy) == [10, 59]
    obj = reopen(tmp_path / "pinned.blend")
    assert held(obj) == [10, 59]
    select(obj, 4)
    bpy.ops.curve.delete(type="VERT")
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(pins.places(obj.data), ARC[[10, 59]])
    UNPIN()
    relax(**SHORT)
    pin(obj, 0)  # keys stay ours there, too
    go_on(max_iterations=2)
    assert held(obj) == [0]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_ends_of_smooth_splines_may_be_pinned(kind):
    obj = add_arc(kind=kind)
    PIN()
    relax(**SHORT, sample_splines=True)
    count = len(obj.data.splines[0].points)
    assert held(obj) == [0, count - 1]
    frames = np.stack(BakedKeys([obj]).frames)[:, [0, -1]]
    np.testing.assert_array_equal(frames, np.broadcast_to(frames[0], frames.shape))


def test_other_points_of_smooth_splines_may_not():
    obj = add_arc(kind="NURBS")
    select(obj, 0, 7)
    with pytest.raises(RuntimeError, match="is a NURBS spline, of which only the ends can be pinned"):
        PIN()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert held(obj) == []
    pins.pin(obj.data.splines[0], np.arange(60) == 7)
    with pytest.raises(RuntimeError, match="of which only the ends can be pinned"):
        relax(sample_splines=True)


def test_no_size_but_the_length_can_be_kept_and_scripts_may_name_them():
    obj = add_arc()
    PIN()
    before = contents()
    with pytest.raises(RuntimeError, match="where something is pinned or avoided; give keep_size='LENGTH'"):
        relax(keep_size="BOX")
    assert contents() == before
    UNPIN()
    Relaxation(obj).relax(pins=(0, 59), **SHORT)
    still(obj, ARC[[0, 59]])
    with pytest.raises(MobiusFlowError, match="pins asks for"):
        Relaxation(obj).relax(pins=(60,), **SHORT)


RING = regular_polygon(30).vertices + np.array([0.0, 0.0, 20.0])


def add_both():
    """A closed spline and an open one in one object."""
    obj = add_curve([RING, ARC])
    obj.data.splines[1].use_cyclic_u = False
    return obj


def cyclic(obj):
    return [spline.use_cyclic_u for spline in obj.data.splines]


def test_a_segment_is_a_curve():
    obj = add_curve([np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])], cyclic=False)
    relax(max_iterations=3, keyframes="RESULT")
    points = stored(obj.data).astype(np.float64)
    np.testing.assert_allclose(points[[0, -1]], [[0, 0, 0], [1, 2, 3]], atol=1e-6)


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_a_smooth_open_spline_becomes_a_polygon_from_end_to_end(kind):
    obj = add_arc(kind=kind)
    obj.data.splines[0].use_endpoint_u = True
    assert bpy.ops.curve.mobius_flow_mend(remedy="TO_POLY") == {"FINISHED"}
    np.testing.assert_allclose(stored(obj.data)[[0, -1]], ARC[[0, -1]], atol=1e-5)  # Blender 4.2 is not that exact
    assert cyclic(obj) == [False]


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_its_smooth_curve_runs_from_end_to_end(kind, capfd):
    add_both()
    obj = relax(**SHORT)
    end = obj.data.shape_keys.key_blocks[-1].data[-1].co.copy()
    assert bpy.ops.curve.mobius_flow_smooth_curve(kind=kind) == {"FINISHED"}
    assert "the same knot, proved" in capfd.readouterr().out
    made = bpy.context.object
    assert cyclic(made) == [True, False]
    np.testing.assert_allclose(evaluated(made)[-1], end, atol=1e-5)
