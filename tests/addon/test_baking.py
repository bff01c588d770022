"""Baked curves are baked again and cleared, at once and in a file that was saved and opened again."""

import bpy
import numpy as np
import pytest
from baked_curves import KEYED, again, blocks, clear, curve_of, go_on, last_frame, reopen, two_rings
from blender_scenes import add_curve, add_trefoil, contents, evaluated, relax, stored
from families import crossed
from mathutils import Vector
from mobius_flow.addon.curves import bake, keyframes
from mobius_flow.core.knots import knot
from shapes import torus_trefoil


def link_of_kind(kind):
    rng = np.random.default_rng(7)
    obj = add_curve([torus_trefoil(24).vertices + 4 * k for k in (0, 1)], kind=kind)
    for spline in obj.data.splines:
        spline.resolution_u = 5
        for point in spline.bezier_points if kind == "BEZIER" else spline.points:
            point.radius, point.tilt = rng.random(2)
            if kind == "BEZIER":
                point.handle_left_type = point.handle_right_type = "ALIGNED"
                point.handle_right = Vector(point.co) + Vector((0.1, 0.2, 0.3))
    obj.data.splines[1].material_index, obj.data.splines[0].use_smooth = 2, False
    obj.data.splines.active = obj.data.splines[0]
    return obj


@pytest.mark.parametrize(("kind", "keyframes", "reopened"), crossed(["POLY", "BEZIER", "NURBS"], KEYED, [False, True]))
def test_clear_gives_the_curve_back(tmp_path, kind, keyframes, reopened):
    obj = link_of_kind(kind)
    before, names = contents(), blocks()
    relax(max_iterations=2, vertices=300, keyframes=keyframes, sample_splines=True)
    assert contents() != before
    if reopened:
        obj = reopen(tmp_path / "a.blend")
    bpy.context.scene.frame_set(3)
    clear()
    after = contents()
    assert all(after[name] == before[name] for name in ("splines", "curves", "actions", "shape_keys", "objects"))
    assert blocks() == names
    assert not obj.data.keys()
    assert obj.data.splines.active == obj.data.splines[0]


@pytest.mark.parametrize("reopened", [False, True])
@pytest.mark.parametrize("keyframes", KEYED)
def test_baking_again_is_baking_the_original(tmp_path, keyframes, reopened):
    obj = add_trefoil()
    relax(max_iterations=7, keyframes=keyframes, start_frame=4)
    names = blocks()
    expected = [evaluated(obj, 4 + k) for k in range(8)]
    clear()
    relax(max_iterations=2, vertices=100, keyframes=keyframes)
    if reopened:
        obj = reopen(tmp_path / "a.blend")
    again(max_iterations=7, keyframes=keyframes, start_frame=4, timing="ITERATE")
    for k, points in enumerate(expected):
        np.testing.assert_array_equal(evaluated(obj, 4 + k), points)
    assert blocks() == names


def test_relax_on_a_baked_curve_is_bake_again():
    obj = add_trefoil()
    relax(max_iterations=4)
    first = keyframes.end_of(obj.data)
    relax(max_iterations=4)
    np.testing.assert_array_equal(keyframes.end_of(obj.data), first)
    assert [len(each) for each in blocks()] == [2, 1, 1], "the curve and its original"


def test_clear_takes_a_fitted_tube_back_but_not_ones_own():
    obj = add_trefoil()
    relax(max_iterations=2, fit_bevel=True)
    assert obj.data.bevel_depth > 0
    clear()
    assert (obj.data.bevel_depth, obj.data.bevel_resolution) == (0, 4)
    relax(max_iterations=2, fit_bevel=True)
    obj.data.bevel_depth = 0.125
    clear()
    assert obj.data.bevel_depth == 0.125


def test_several_together(tmp_path):
    pair = two_rings()
    before = [stored(obj.data) for obj in pair]
    relax(max_iterations=3)
    pair[0].name, pair[0].data.name = "Renamed", "Also"
    go_on(max_iterations=3, timing="ITERATE")
    assert [last_frame(obj) for obj in pair] == [7, 7]
    reopen(tmp_path / "a.blend")
    pair = [bpy.data.objects["Renamed"], bpy.data.objects["B"]]
    again(max_iterations=2, timing="ITERATE")
    assert [last_frame(obj) for obj in pair] == [3, 3]
    assert pair[0].data.name == "Also"
    clear()
    for obj, points in zip(pair, before, strict=True):
        np.testing.assert_array_equal(stored(obj.data), points)
    assert [len(each) for each in blocks()] == [2, 0, 0]


def test_frames_per_iterate_alone_means_by_iterate():
    obj = add_trefoil()
    bpy.ops.curve.mobius_flow_relax(max_iterations=4, frames_per_iterate=2.5)
    frames = {point.co[0] for point in curve_of(obj).keyframe_points}
    assert {1, 3.5, 6, 8.5, 11} <= frames
    assert max(frames) == 11
    bpy.ops.curve.mobius_flow_relax(max_iterations=4)
    assert curve_of(obj).keyframe_points[-1].co[0] == 250


def test_there_and_back():
    obj = add_trefoil()
    relax(max_iterations=5, timing="EVEN", length=60, hold_end=4, hold_start=3, loop=True)
    assert bake.scene_range([obj]) == (1, 60)
    assert (
        obj.data.eval_time == pytest.approx(obj.data.shape_keys.eval_time) if hasattr(obj.data, "eval_time") else True
    )
    shapes = [evaluated(obj, frame) for frame in range(1, 62)]
    for k in range(31):
        np.testing.assert_allclose(shapes[k], shapes[60 - k], atol=1e-5)
    np.testing.assert_array_equal(shapes[0], shapes[60])
    np.testing.assert_array_equal(shapes[26], shapes[34])
    assert not np.array_equal(shapes[0], shapes[30])
    with pytest.raises(RuntimeError, match="Loop goes with keyframes='SHAPE_KEYS' only"):
        relax(max_iterations=5, keyframes="FCURVES", loop=True)


def test_constant_thickness_is_the_least():
    obj = add_curve([knot("5_2", 60).vertices])
    relax(max_iterations=8, fit_bevel=True)
    radii = [block.data[0].radius * obj.data.bevel_depth for block in obj.data.shape_keys.key_blocks]
    relax(max_iterations=8, fit_bevel=True, constant_radius=True)
    constant = [block.data[0].radius * obj.data.bevel_depth for block in obj.data.shape_keys.key_blocks]
    assert max(radii) > 1.05 * min(radii)
    assert constant == pytest.approx([min(radii)] * len(radii), rel=1e-5)
    assert bpy.ops.curve.mobius_flow_continue(max_iterations=8, timing="ITERATE") == {"FINISHED"}
    further = [block.data[0].radius for block in obj.data.shape_keys.key_blocks[len(constant) :]]
    assert len(further) == 8
    assert np.ptp(further) < 1e-6
