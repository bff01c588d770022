"""What was baked stays as it is where something fails, is refused, or is not the program's own."""

import bpy
import numpy as np
import pytest
from baked_curves import KEYED, SHORT, again, blocks, clear, go_on
from blender_scenes import add_trefoil, contents, evaluated, linked, relax, show
from mobius_flow.addon.curves import keyframes


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


def test_what_was_not_baked_cannot_be_baked_again():
    add_trefoil()
    for call in (
        bpy.ops.curve.mobius_flow_bake_again,
        bpy.ops.curve.mobius_flow_continue,
        bpy.ops.curve.mobius_flow_clear,
        bpy.ops.curve.mobius_flow_keep_size,
    ):
        with pytest.raises(RuntimeError, match="'Knot' has no keys of Möbius Flow; press Relax first"):
            call()
    with pytest.raises(RuntimeError, match="Select a curve that was baked first"):
        bpy.ops.curve.mobius_flow_scene_range()


def test_to_continue_takes_the_points_that_there_are_and_says_so():
    obj = add_trefoil()
    relax(max_iterations=3, vertices=40)
    assert bpy.ops.curve.mobius_flow_continue(**SHORT, vertices=90) == {"FINISHED"}
    assert len(obj.data.splines[0].points) == 40


def test_nobody_is_told_to_relax_what_has_other_keys_than_it_was_baked_with():
    obj = add_trefoil()
    relax(max_iterations=3)
    obj.shape_key_add(name="Mine")
    before = contents()
    sentence = "'Knot' has other keys or points than it was baked with; undo that, or relax a copy"
    operators = bpy.ops.curve
    for call in (
        clear,
        operators.mobius_flow_keep_size,
        operators.mobius_flow_continue,
        operators.mobius_flow_bake_again,
    ):
        with pytest.raises(RuntimeError, match=sentence):
            call()
    assert contents() == before
    obj.shape_key_remove(obj.data.shape_keys.key_blocks["Mine"])
    clear()
    assert len(obj.data.splines[0].points) == 30


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
    show(linked(tmp_path / "a.blend", "objects", "Knot"))
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
