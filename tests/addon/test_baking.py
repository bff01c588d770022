"""Baked curves are baked again, go on and are cleared, at once and in a file that was opened again."""

import bpy
import numpy as np
import pytest
from baked_curves import SHORT, again, blocks, clear, go_on, last_frame
from blender_scenes import add_curve, add_trefoil, contents, evaluated, relax, stored
from mobius_flow.addon.curves import keyframes
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core.knots import knot


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


def test_constant_thickness_is_the_least():
    obj = add_curve([knot("5_2", 60).vertices])
    relax(max_iterations=8, fit_bevel=True, radius="none")
    radii = [block.data[0].radius * obj.data.bevel_depth for block in obj.data.shape_keys.key_blocks]
    relax(max_iterations=8, fit_bevel=True, radius="none", constant_radius=True)
    constant = [block.data[0].radius * obj.data.bevel_depth for block in obj.data.shape_keys.key_blocks]
    assert max(radii) > 1.05 * min(radii)
    assert constant == pytest.approx([min(radii)] * len(radii), rel=1e-5)
    assert bpy.ops.curve.mobius_flow_continue(max_iterations=8) == {"FINISHED"}
    further = [block.data[0].radius for block in obj.data.shape_keys.key_blocks[len(constant) :]]
    assert len(further) == 8
    assert np.ptp(further) < 1e-6


def test_keys_of_earlier_versions_an_f_curve_for_every_coordinate_can_be_cleared():
    obj = add_trefoil()
    before = stored(obj.data)
    relax(**SHORT)
    obj.shape_key_clear()
    for axis in range(3):
        keyframes.add_keys(obj.data, "Relaxation", "splines[0].points[0].co", axis, np.arange(2.0), np.arange(2.0))
    with pytest.raises(RuntimeError, match="'Knot' has keys of an earlier version; press Clear first"):
        relax(**SHORT)
    clear()
    assert np.array_equal(stored(obj.data), before)
    relax(**SHORT)


def test_an_animation_without_motion_goes_on():
    obj = add_trefoil()
    relax(max_iterations=0)
    assert last_frame(obj) == 1
    go_on(max_iterations=3)
    assert last_frame(obj) == 4
    again(max_iterations=400)
    end, shown = last_frame(obj), keyframes.keyed_points(obj.data)[-1]
    go_on(max_iterations=400, tolerance=0.01)  # there is nothing left to do
    assert last_frame(obj) == end
    np.testing.assert_array_equal(keyframes.keyed_points(obj.data)[-1], shown)


@pytest.mark.parametrize("call", [bpy.ops.curve.mobius_flow_bake_again, bpy.ops.curve.mobius_flow_continue])
def test_a_failure_gives_the_baked_curve_back(monkeypatch, call):
    obj = add_trefoil()
    relax(max_iterations=3)
    data, points = obj.data, [evaluated(obj, k) for k in (1, 2, 4)]
    before, names = contents(), blocks()
    written = keyframes.write

    def failing(*arguments):
        written(*arguments)
        raise MemoryError

    monkeypatch.setattr(keyframes, "write", failing)
    with pytest.raises(RuntimeError, match="Memory ran out; all is as it was"):
        call(**SHORT)
    assert contents() == before
    assert blocks() == names
    assert obj.data == data
    assert not data.use_fake_user
    for k, shown in zip((1, 2, 4), points, strict=True):
        np.testing.assert_array_equal(evaluated(obj, k), shown)


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


MOVES = {"untangle": "always", "max_iterations": 3}


def test_strand_moves_are_shown_and_tubes_fitted_at_all_keys(operator):
    obj = add_curve([knot("braid(1,-2,3)", 40).vertices])
    obj.data.bevel_depth = 0.1
    operator.given |= MOVES | {"fit_bevel": True, "any_bevel": True}
    operator.start()
    counts = set()
    operator.until(lambda: counts.add(len(obj.data.splines[0].points)))
    assert operator.run.report.certified
    assert len(counts) < 8  # points change only where there come more
    assert min(block.data[0].radius for block in obj.data.shape_keys.key_blocks) > 0.0
    assert bpy.ops.curve.mobius_flow_continue(max_iterations=3, untangle="always") == {"FINISHED"}
    assert BakedKeys([obj]).unproved == 0


def test_the_scene_plays_what_is_asked_for_unless_it_is_negative(capfd):
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
    sentence = "only, the animation has -9 to 30: no scene plays negative frames, so bake again with a later Start"
    relax(max_iterations=3, timing="EVEN", length=40, start_frame=-9)
    assert f"The scene plays frames 6 to 45 {sentence}" in capfd.readouterr().out
    bpy.ops.curve.mobius_flow_scene_range()
    assert f"The scene plays frames 0 to 30 {sentence}" in capfd.readouterr().out
    assert (scene.frame_start, scene.frame_end) == (0, 30)
