"""The button for what might be crossed, and what the sidebar says of it."""

from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_curve, linked, sentence
from mobius_flow.addon.curves.surroundings import warning
from mobius_flow.addon.live.selection import avoided
from shapes import regular_polygon


def cube(name, place):
    bpy.ops.mesh.primitive_cube_add(location=place)
    obj = bpy.context.object
    obj.name = name
    obj.select_set(False)
    return obj


@pytest.fixture
def scene():
    """A ring, selected, two cubes near it and one far away."""
    near, other, far = cube("Near", (0, 0, 0)), cube("Other", (1, 0, 0)), cube("Far", (50, 0, 0))
    ring = add_curve([regular_polygon(20).vertices], "Ring")
    bpy.context.view_layer.update()
    return SimpleNamespace(ring=ring, near=near, other=other, far=far)


def collection():
    return bpy.context.scene.mobius_flow_surroundings.avoid


def names(objects):
    return sorted(obj.name for obj in objects)


def test_what_is_near_is_put_into_a_collection_of_the_scene(scene, capfd, tmp_path):
    before = scene.near.users_collection
    assert warning(bpy.context, [scene.ring], avoided(bpy.context)).startswith("'Near' and 'Other' nearby are neither")
    assert bpy.ops.curve.mobius_flow_avoid() == {"FINISHED"}
    assert "'Avoid' has 'Near' and 'Other' now" in capfd.readouterr().out
    assert names(collection().objects) == ["Near", "Other"]
    assert collection().name in bpy.context.scene.collection.children
    assert set(before) < set(scene.near.users_collection), "it stays where it was, too"
    assert warning(bpy.context, [scene.ring], avoided(bpy.context)) is None
    assert not bpy.ops.curve.mobius_flow_avoid.poll()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert names(collection().objects) == ["Near", "Other"]


def test_a_collection_that_is_chosen_is_used(scene):
    mine = bpy.data.collections.new("Walls")
    mine.objects.link(scene.near)
    bpy.context.scene.mobius_flow_surroundings.avoid = mine
    assert warning(bpy.context, [scene.ring], avoided(bpy.context)).startswith("'Other' nearby is neither")
    bpy.ops.curve.mobius_flow_avoid()
    assert names(mine.objects) == ["Near", "Other"]
    assert "Avoid" not in bpy.data.collections


def test_what_is_avoided_is_seen_has_a_shape_and_is_not_selected(scene):
    mine, inner = bpy.data.collections.new("Walls"), bpy.data.collections.new("Inner")
    bpy.context.scene.collection.children.link(mine)
    mine.children.link(inner)
    for each in (scene.near, scene.ring, bpy.data.objects.new("Empty", None)):
        mine.objects.link(each)
    for each in (scene.other, scene.far, bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))):
        inner.objects.link(each)
    scene.far.hide_set(True)
    bpy.context.scene.mobius_flow_surroundings.avoid = mine
    assert names(avoided(bpy.context)) == ["Near", "Other"]
    assert names(avoided(bpy.context, "Inner")) == ["Other"]
    assert avoided(bpy.context, "") == []


def test_collections_of_other_files_are_left_alone(tmp_path):
    mine = bpy.data.collections.new("Walls")
    mine.use_fake_user = True
    bpy.context.scene.collection.children.link(mine)
    block = linked(tmp_path / "walls.blend", "collections", "Walls")
    bpy.context.scene.mobius_flow_surroundings.avoid = block
    cube("Near", (0, 0, 0))
    add_curve([regular_polygon(20).vertices], "Ring")
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_avoid()
    assert sentence(error.value) == "'Walls' is linked from another file; choose another collection to avoid"
    assert len(block.objects) == 0
