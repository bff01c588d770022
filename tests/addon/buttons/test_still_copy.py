"""A still copy has the shape that is shown, and nothing that moves it; the original keeps everything."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, contents, evaluated, stored
from mended_curves import may_be_relaxed, mend, relax_once, two, with_material
from mobius_flow.addon.live.requirements import RELAXABLE, UNEDITED, Remedy


def copied():
    """Take a still copy of what is active, which must stay as it is; the copy."""
    bpy.context.view_layer.update()
    original = bpy.context.object
    before = contents()["splines"]
    shown = evaluated(original)
    assert bpy.ops.curve.mobius_flow_mend(remedy="COPY") == {"FINISHED"}
    (copy,) = bpy.context.selected_objects
    assert copy == bpy.context.object != original
    assert {name: value for name, value in contents()["splines"].items() if name in before} == before
    np.testing.assert_array_equal(evaluated(original), shown)
    return copy


def test_a_copy_has_the_shape_of_the_keys_without_them():
    obj = with_material(add_trefoil())
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Mine")
    key.data[3].co.z += 0.5
    key.value = 0.5
    bpy.context.view_layer.update()
    assert RELAXABLE(bpy.context).remedy is Remedy.COPY
    shown = evaluated(obj)
    copy = copied()
    assert copy.data.shape_keys is None
    assert [block.name for block in obj.data.shape_keys.key_blocks] == ["Basis", "Mine"]
    np.testing.assert_array_equal(stored(copy.data), shown)
    assert copy.data.materials[0].name == "Gold"
    may_be_relaxed()


def test_a_turned_curve_keeps_its_points_bit_for_bit():
    obj = add_trefoil()
    obj.rotation_euler, obj.scale, obj.location = (0.3, 0.2, 0.1), (1.1, 2, 0.7), (3, 2, 1)
    copy = copied()
    np.testing.assert_array_equal(stored(copy.data), stored(obj.data))
    assert copy.matrix_world == obj.matrix_world


def test_a_copy_has_no_animation():
    obj = add_trefoil()
    obj.data.bevel_depth = 0.1
    obj.data.keyframe_insert("bevel_depth", frame=1)
    assert RELAXABLE(bpy.context).remedy is Remedy.COPY
    copy = bpy.ops.curve.mobius_flow_mend(remedy="COPY") and bpy.context.object
    assert copy.data.animation_data is None
    assert copy.data.bevel_depth == pytest.approx(0.1)
    assert obj.data.animation_data.action is not None
    may_be_relaxed()


def test_a_copy_has_no_drivers():
    obj = add_trefoil()
    obj.data.driver_add("splines[0].points[3].co", 1)
    assert RELAXABLE(bpy.context).remedy is Remedy.COPY
    assert copied().data.animation_data is None
    may_be_relaxed()


def test_keys_that_were_edited_are_copied_as_they_are():
    obj = relax_once()
    obj.data.shape_keys.key_blocks[0].data[7].co.x += 0.125
    bpy.context.scene.frame_set(1)
    bpy.context.view_layer.update()
    assert UNEDITED(bpy.context).remedy is Remedy.COPY
    shown = evaluated(obj)
    copy = copied()
    np.testing.assert_array_equal(stored(copy.data), shown)
    assert UNEDITED(bpy.context) is None
    may_be_relaxed()


def test_copies_stand_still_where_their_originals_are():
    first, second = two()
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale, parent.rotation_euler = (1, 2, 1), (0.3, 0, 0)
    first.parent, first.rotation_euler = parent, (0, 0, 0.7)
    first.keyframe_insert("location", frame=1)
    second.constraints.new("COPY_SCALE").target = parent
    bpy.context.view_layer.update()
    places = {obj.name: world(obj) for obj in (first, second)}
    mend(Remedy.COPY)
    copies = bpy.context.selected_objects
    assert len(copies) == 2
    assert not {first, second} & set(copies)
    for obj in copies:
        assert obj.parent is None
        assert not obj.constraints
        assert obj.animation_data is None
        np.testing.assert_allclose(world(obj), places[obj.name[0]], atol=1e-5)
    assert first.parent == parent
    assert first.animation_data is not None
    assert len(second.constraints) == 1
    may_be_relaxed()


def world(obj):
    return stored(obj.data) @ np.array(obj.matrix_world)[:3, :3].T + np.array(obj.matrix_world)[:3, 3]


def test_only_what_needs_it_is_copied():
    plain, keyed = two()
    keyed.shape_key_add(name="Mine")
    mend(Remedy.COPY)
    assert plain.select_get()
    assert not keyed.select_get()
    assert len(bpy.context.selected_objects) == 2
    may_be_relaxed()
    assert [block.name for block in keyed.data.shape_keys.key_blocks] == ["Mine"]


def test_a_copy_lies_in_the_collections_of_its_original():
    collection = bpy.data.collections.new("Mine")
    bpy.context.scene.collection.children.link(collection)
    obj = add_trefoil()
    collection.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    assert copied().users_collection == (collection,)
