"""Baked curves are baked again, continued and cleared, at once and in a file that was saved and opened again."""

from itertools import pairwise

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_curve, add_hopf_link, add_trefoil, contents, evaluated, fcurves, relax, stored  # noqa: E402
from mathutils import Vector  # noqa: E402
from mobius_flow.addon.curves import keyframes  # noqa: E402
from mobius_flow.core.collision import is_free  # noqa: E402
from mobius_flow.core.curve import Mesh  # noqa: E402
from shapes import torus_trefoil  # noqa: E402

SHORT = {"max_iterations": 5, "fit_bevel": False}
KEYED = ["SHAPE_KEYS", "FCURVES"]


def again(**options):
    assert bpy.ops.curve.mobius_flow_bake_again(**SHORT | options) == {"FINISHED"}


def go_on(**options):
    assert bpy.ops.curve.mobius_flow_continue(**SHORT | options) == {"FINISHED"}


def clear():
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}


def reopen(path):
    """Save the file, close it, open it again, and select what was selected."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.object


def blocks():
    """Names of all there is that keys are made of."""
    return [sorted(block.name for block in each) for each in (bpy.data.curves, bpy.data.shape_keys, bpy.data.actions)]


def last_frame(obj):
    owner = obj.data.shape_keys or obj.data
    return max(curve.keyframe_points[-1].co[0] for curve in fcurves(owner))


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


@pytest.mark.parametrize("reopened", [False, True])
@pytest.mark.parametrize("keyframes", KEYED)
@pytest.mark.parametrize("kind", ["POLY", "BEZIER", "NURBS"])
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
    assert [len(each) for each in blocks()] == [1, 1, 1]


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


def test_continuing_by_length_goes_on_after_the_rest():
    obj = add_trefoil()
    relax(max_iterations=3, timing="EVEN", length=50, hold_end=10)
    go_on(length=100, hold_start=5, hold_end=2)
    (curve,) = fcurves(obj.data.shape_keys)
    frames = [point.co[0] for point in curve.keyframe_points]
    assert frames[3] == 40
    assert (frames[4], frames[-1]) == (55, 148)
    np.testing.assert_array_equal(evaluated(obj, 55), evaluated(obj, 40))
    clear()
    assert len(obj.data.splines[0].points) == 30


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


def two_rings():
    vertices = add_hopf_link(24)
    points = stored(vertices.data)
    bpy.data.objects.remove(vertices)
    for block in (*bpy.data.curves,):
        bpy.data.curves.remove(block)
    pair = [add_curve([part], name) for part, name in zip(np.split(points, 2), "AB", strict=True)]
    pair[1].location.x = 0.25
    pair[0].rotation_euler.z = 0.5
    bpy.context.view_layer.update()
    return pair


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


@pytest.mark.parametrize("call", [bpy.ops.curve.mobius_flow_bake_again, bpy.ops.curve.mobius_flow_continue])
@pytest.mark.parametrize("keyframes_as", KEYED)
def test_a_failure_gives_the_baked_curve_back(monkeypatch, call, keyframes_as):
    obj = add_trefoil()
    relax(max_iterations=3, keyframes=keyframes_as)
    data, points = obj.data, [evaluated(obj, k) for k in (1, 2, 4)]
    before, names = contents(), blocks()
    written = keyframes.writing

    def failing(*arguments):
        yield from written(*arguments)
        raise MemoryError

    monkeypatch.setattr(keyframes, "writing", failing)
    with pytest.raises(RuntimeError, match="Memory ran out; all is as it was"):
        call(**SHORT)
    assert contents() == before
    assert blocks() == names
    assert obj.data == data
    assert not data.use_fake_user
    for k, shown in zip((1, 2, 4), points, strict=True):
        np.testing.assert_array_equal(evaluated(obj, k), shown)


@pytest.mark.parametrize(
    ("options", "said"), [({"tolerance": float("nan")}, "tolerance"), ({"start_frame": 2**21}, "Start Frame")]
)
def test_bad_options_leave_the_baked_curve(options, said):
    obj = add_trefoil()
    relax(max_iterations=3)
    before, data = contents(), obj.data
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.curve.mobius_flow_bake_again(**options)
    assert contents() == before
    assert obj.data == data


def test_what_was_not_baked_cannot_be_baked_again():
    add_trefoil()
    for call in (
        bpy.ops.curve.mobius_flow_bake_again,
        bpy.ops.curve.mobius_flow_continue,
        bpy.ops.curve.mobius_flow_clear,
    ):
        with pytest.raises(RuntimeError, match="'Knot' has no keys of Möbius Flow; press Relax first"):
            call()
    with pytest.raises(RuntimeError, match="Select a curve that was baked first"):
        bpy.ops.curve.mobius_flow_scene_range()


@pytest.mark.parametrize(
    "call",
    [bpy.ops.curve.mobius_flow_relax, bpy.ops.curve.mobius_flow_continue, bpy.ops.curve.mobius_flow_clear],
)
@pytest.mark.parametrize("key", [0, 2, -1])
def test_keys_that_were_edited_are_not_lost(call, key):
    obj = add_trefoil()
    relax(max_iterations=4)
    obj.data.shape_keys.key_blocks[key].data[7].co.x += 0.125
    before, data = contents(), obj.data
    with pytest.raises(RuntimeError, match="Keys of 'Knot' were edited; undo that, or remove the keys to relax the"):
        call()
    assert contents() == before
    assert obj.data == data


def test_a_look_into_edit_mode_edits_nothing():
    obj = add_trefoil()
    relax(max_iterations=4)
    for key in (0, 3):
        obj.active_shape_key_index = key
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.object.mode_set(mode="OBJECT")
    again()
    clear()


def test_a_linked_baked_curve_is_left_alone(tmp_path):
    add_trefoil()
    relax(max_iterations=2)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (_, linked):
        linked.objects = ["Knot"]
    (obj,) = linked.objects
    bpy.context.scene.collection.objects.link(obj)
    obj.select_set(True)
    for call in (bpy.ops.curve.mobius_flow_relax, bpy.ops.curve.mobius_flow_clear):
        with pytest.raises(RuntimeError, match="'Knot' is linked from another file"):
            call()


def test_a_copy_has_an_animation_of_its_own():
    obj = add_trefoil()
    relax(max_iterations=3)
    shown = evaluated(obj, 3)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    assert copy != obj
    clear()
    assert copy.data.shape_keys is None
    np.testing.assert_array_equal(evaluated(obj, 3), shown)


def test_retimed_keys_go_on_where_they_end_now():
    obj = add_trefoil()
    relax(max_iterations=2)
    (curve,) = fcurves(obj.data.shape_keys)
    for point in curve.keyframe_points:
        point.co[0] = 10 * point.co[0]
    go_on(max_iterations=2, timing="ITERATE")
    assert [point.co[0] for point in curve_of(obj).keyframe_points] == [10, 20, 30, 31, 32]


def curve_of(obj):
    (curve,) = fcurves(obj.data.shape_keys)
    return curve


def test_drivers_and_settings_of_the_curve_stay():
    obj = add_trefoil()
    data = obj.data
    data.use_fake_user, data["mine"] = True, 3
    other = bpy.data.objects.new("Other", None)
    bpy.context.scene.collection.objects.link(other)
    driver = other.driver_add("location", 0).driver
    driver.variables.new().targets[0].id_type = "CURVE"
    driver.variables[0].targets[0].id = data
    relax(max_iterations=2)
    again()
    go_on()
    assert driver.variables[0].targets[0].id == obj.data
    assert (obj.data.use_fake_user, obj.data["mine"], obj.data.name) == (True, 3, "Knot")
    assert obj.data.users == 2  # the object and the fake one


def test_the_scene_plays_what_is_asked_for(capfd):
    add_trefoil()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 40
    relax(max_iterations=3, timing="EVEN", length=40)
    assert "Set Scene Range" not in capfd.readouterr().out
    relax(max_iterations=3, timing="EVEN", length=40, hold_end=5, start_frame=6)
    said = capfd.readouterr().out
    assert "The scene plays frames 1 to 40 only, the animation has 6 to 45: press Set Scene Range" in said
    assert bpy.ops.curve.mobius_flow_scene_range() == {"FINISHED"}
    assert (scene.frame_start, scene.frame_end) == (6, 45)
    assert not capfd.readouterr().out


def test_nobody_is_told_to_play_negative_frames(capfd):
    add_trefoil()
    scene = bpy.context.scene
    sentence = "only, the animation has -9 to 30: no scene plays negative frames, so bake again with a later Start"
    relax(max_iterations=3, timing="EVEN", length=40, start_frame=-9)
    assert f"The scene plays frames 1 to 250 {sentence}" in capfd.readouterr().out
    bpy.ops.curve.mobius_flow_scene_range()
    assert f"The scene plays frames 0 to 30 {sentence}" in capfd.readouterr().out
    assert (scene.frame_start, scene.frame_end) == (0, 30)


def test_frames_per_iterate_alone_means_by_iterate():
    obj = add_trefoil()
    bpy.ops.curve.mobius_flow_relax(max_iterations=4, frames_per_iterate=2.5)
    assert [point.co[0] for point in curve_of(obj).keyframe_points] == [1, 3.5, 6, 8.5, 11]
    bpy.ops.curve.mobius_flow_relax(max_iterations=4)
    assert curve_of(obj).keyframe_points[-1].co[0] == 250


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
