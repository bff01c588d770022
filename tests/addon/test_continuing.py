"""Animations go on from their ends: what is added, when, and as what."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from baked_curves import KEYED, again, blocks, clear, curve_of, go_on, last_frame, reopen, two_rings
from blender_scenes import add_trefoil, evaluated, relax, stored
from mobius_flow.addon.curves import bake, keyframes
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve import Mesh
from mobius_flow.core.keys import key_options


@pytest.mark.parametrize("reopened", [False, True])
@pytest.mark.parametrize("keyframes", KEYED)
def test_continuing_adds_proved_keys_after_the_old_ones(tmp_path, capfd, keyframes, reopened):
    obj = add_trefoil()
    relax(max_iterations=4, keyframes=keyframes)
    old = [evaluated(obj, 1 + k) for k in range(5)]
    names = blocks()
    if reopened:
        obj = reopen(tmp_path / "a.blend")
    bpy.context.scene.frame_set(2)  # F-curves leave the points of this frame in the curve
    capfd.readouterr()
    go_on(max_iterations=2, timing="ITERATE", keyframes="RESULT")
    assert "2 new keys up to frame 7, proved free of contact" in capfd.readouterr().out
    shown = [evaluated(obj, 1 + k) for k in range(7)]
    np.testing.assert_array_equal(shown[:5], old)
    mesh = Mesh((len(old[0]),))
    for a, b in pairwise(shown):
        assert not np.array_equal(a, b)
        assert is_free(mesh, a.astype(np.float64), b.astype(np.float64))
    assert last_frame(obj) == 7
    assert blocks() == names


def test_continuing_by_length_goes_on_after_the_rest(monkeypatch):
    monkeypatch.setattr(key_options, "_SLOWEST", 1e9)
    obj = add_trefoil()
    relax(max_iterations=3, timing="DISTANCE", length=50, hold_end=10)
    go_on(timing="DISTANCE", length=100, hold_start=5, hold_end=2)
    curve = curve_of(obj)
    frames = [point.co[0] for point in curve.keyframe_points]
    rest = frames.index(40)
    assert frames[rest + 1] - 55 < np.diff(frames[rest + 1 :]).max() + 1e-3
    assert frames[-1] == 148
    np.testing.assert_array_equal(evaluated(obj, 55), evaluated(obj, 40))
    clear()
    assert len(obj.data.splines[0].points) == 30


def test_the_rest_at_the_beginning_is_still_played_after_continuing(monkeypatch):
    monkeypatch.setattr(key_options, "_SLOWEST", 1e9)
    obj = add_trefoil()
    relax(max_iterations=3, timing="DISTANCE", length=50, hold_start=10, hold_end=5)
    go_on(timing="DISTANCE", length=100, hold_start=3, hold_end=2)
    assert bake.scene_range([obj]) == (1, 150)


def test_no_motion_takes_no_length():
    obj = add_trefoil()
    relax(max_iterations=400, timing="EVEN", length=50)
    go_on(timing="EVEN", length=100, tolerance=1e-3)
    first, last = bake.scene_range([obj])
    assert first == 1
    assert 50 <= last <= 60


def test_what_ends_where_it_begins_is_not_continued():
    add_trefoil()
    relax(max_iterations=3, timing="EVEN", length=50, loop=True)
    with pytest.raises(RuntimeError, match="'Knot' ends where it begins; switch Loop off first"):
        go_on(max_iterations=1)


def test_one_new_key_is_not_called_keys(capfd):
    add_trefoil()
    relax(max_iterations=3)
    go_on(max_iterations=1, timing="ITERATE")
    assert "; 1 new key up to frame 5, proved" in capfd.readouterr().out


def test_continuing_gets_where_a_longer_run_gets():
    obj = add_trefoil()
    relax(max_iterations=3)
    go_on(max_iterations=400)
    split = keyframes.end_of(obj.data).astype(np.float64)
    relax(max_iterations=400)
    whole = keyframes.end_of(obj.data).astype(np.float64)
    lengths = [np.sort(np.linalg.norm(p - p.mean(axis=0), axis=1)) for p in (split, whole)]
    np.testing.assert_allclose(*lengths, atol=2e-2)


@pytest.mark.parametrize("keyframes", [*KEYED, "RESULT"])
def test_a_fitted_tube_keeps_its_radius_when_it_goes_on(keyframes):
    """Its keys go on as what they are, whatever is asked for."""
    obj = add_trefoil()
    relax(max_iterations=4, fit_bevel=True)

    def radius(block):
        return obj.data.bevel_depth * block.data[0].radius

    before = [radius(block) for block in obj.data.shape_keys.key_blocks]
    go_on(max_iterations=30, fit_bevel=True, keyframes=keyframes)
    after = [radius(block) for block in obj.data.shape_keys.key_blocks]
    np.testing.assert_allclose(after[:5], before, rtol=1e-5)
    assert after[-1] == pytest.approx(obj.data.bevel_depth)


def test_baked_apart_they_go_on_together():
    """The one that rests earlier waits for the other."""
    pair = two_rings()
    for obj, count in zip(pair, (2, 5), strict=True):
        bpy.ops.object.select_all(action="DESELECT")
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
        relax(max_iterations=count)
    ends = [keyframes.end_of(obj.data) for obj in pair]
    for obj in pair:
        obj.select_set(True)
    go_on(max_iterations=2, timing="ITERATE")
    for obj, end in zip(pair, ends, strict=True):
        np.testing.assert_array_equal(evaluated(obj, 6), end)
        assert last_frame(obj) == 8


def test_retimed_keys_go_on_where_they_end_now():
    obj = add_trefoil()
    relax(max_iterations=2)
    curve = curve_of(obj)
    for point in curve.keyframe_points:
        point.co[0] = 10 * point.co[0]
    go_on(max_iterations=2, timing="ITERATE")
    assert [point.co[0] for point in curve_of(obj).keyframe_points] == [10, 20, 30, 31, 32]


@pytest.mark.parametrize("keyframes_as", KEYED)
def test_an_animation_without_motion_goes_on(keyframes_as):
    obj = add_trefoil()
    relax(max_iterations=0, keyframes=keyframes_as)
    assert last_frame(obj) == 1
    go_on(max_iterations=3, timing="ITERATE")
    assert last_frame(obj) == 4
    again(max_iterations=400, keyframes=keyframes_as, timing="ITERATE")
    end, shown = last_frame(obj), keyframes.end_of(obj.data)
    go_on(max_iterations=400, tolerance=0.01)  # there is nothing left to do
    assert last_frame(obj) == end
    np.testing.assert_array_equal(keyframes.end_of(obj.data), shown)


def test_what_was_thinned_goes_on_thinned():
    obj = add_trefoil()
    relax(max_iterations=6, max_keys=3)
    go_on(max_iterations=2, max_keys=2)
    assert 4 <= len(obj.data.shape_keys.key_blocks) < 9
    mesh = Mesh((len(stored(obj.data)),))
    points = [np.array([p.co[:] for p in block.data]) for block in obj.data.shape_keys.key_blocks]
    assert all(is_free(mesh, a, b) for a, b in pairwise(points))
