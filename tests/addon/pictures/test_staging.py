"""A stage in an artist's scene: all is in sight, what was there comes back, and nothing piles up."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, drawn, relax
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
from mobius_flow.addon.curves import surroundings
from mobius_flow.addon.curves.recorded import WorldMotion
from mobius_flow.addon.pictures import stage, staging
from mobius_flow.core import CurveError
from shapes import lattice_knot

KINDS = ("objects", "cameras", "lights", "meshes", "materials", "worlds", "collections", "actions")


def blocks():
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in KINDS}


def own_camera_and_world(scene):
    scene.camera = bpy.data.objects.new("Mine", bpy.data.cameras.new("Mine"))
    scene.collection.objects.link(scene.camera)
    scene.world = bpy.data.worlds.new("Mine")


def baked(**options):
    add_curve([lattice_knot("4_1").vertices])
    obj = relax(**{"max_iterations": 8, "vertices": 120} | options)
    obj.data.bevel_depth = 0.1
    return obj


def see(scene, objects, frames):
    """Check that the camera sees all of some objects, which stay above the floor; the largest part of the picture."""
    (floor,) = [obj for obj in scene.objects if obj.name.startswith("Floor")]
    widest = 0.0
    for frame in frames:
        scene.frame_set(frame)
        points = np.concatenate([drawn(obj) for obj in objects])
        seen = np.array([world_to_camera_view(scene, scene.camera, Vector(point)) for point in points])
        assert seen[:, :2].min() > 0
        assert seen[:, :2].max() < 1
        assert seen[:, 2].min() > 0
        assert points[:, 2].min() > floor.matrix_world.translation.z
        widest = max(widest, np.ptp(seen[:, :2], axis=0).max())
    return widest


@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "FCURVES"])
@pytest.mark.parametrize("size", [(640, 360), (360, 640)])
def test_the_whole_animation_is_in_sight(keyframes, size):
    obj, scene = baked(keyframes=keyframes), bpy.context.scene
    obj.location, obj.rotation_euler, obj.scale = (30, -20, 5), (0.3, 0.2, 0.1), (2, 1, 0.5)
    bpy.context.view_layer.update()
    scene.render.resolution_x, scene.render.resolution_y = size
    staging.set_up(scene, [obj])
    assert see(scene, [obj], range(1, 10)) > 0.5


def test_an_object_that_something_moves_is_in_sight():
    obj, scene = baked(), bpy.context.scene
    for frame, place in ((1, (0, 0, 0)), (40, (60, 0, 9))):
        obj.location = place
        obj.keyframe_insert("location", frame=frame)
    scene.frame_end = 40
    scene.frame_set(17, subframe=0.5)
    staging.set_up(scene, [obj])
    assert (scene.frame_current, scene.frame_subframe) == (17, 0.5)
    see(scene, [obj], range(1, 41, 3))


def test_several_objects_with_keys_at_different_frames():
    one = baked(start_frame=1)
    one.select_set(False)
    other = baked(start_frame=21)
    other.location.x = 12
    bpy.context.view_layer.update()
    staging.set_up(bpy.context.scene, [one, other])
    see(bpy.context.scene, [one, other], range(1, 31, 2))


def test_a_curve_without_keys_has_a_camera_at_rest():
    obj, scene = add_trefoil(), bpy.context.scene
    obj.data.bevel_depth = 0.1
    staging.set_up(scene, [obj])
    see(scene, [obj], [1])
    assert scene.camera.animation_data is None


def test_the_floor_is_level_and_the_curve_lies_across_the_picture():
    points = np.random.default_rng(3).normal(size=(40, 3)) * [1, 9, 3]
    axes, elevation = stage.facing([points], np.array([0.0, 0.0, 1.0]))
    assert 0.6 < elevation < 1.2
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0
    np.testing.assert_allclose(axes[2], [0, 0, 1])
    assert np.ptp(points @ axes[0]) > 2 * np.ptp(points @ axes[1])


def test_your_own_camera_and_world_are_only_put_aside(tmp_path):
    obj, scene = baked(), bpy.context.scene
    own_camera_and_world(scene)
    before = blocks()
    staging.set_up(scene, [obj])
    assert scene.camera.name != "Mine"
    assert scene.world.name != "Mine"
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    staging.strike(scene)
    assert (scene.camera.name, scene.world.name) == ("Mine", "Mine")
    assert blocks() == before
    assert staging.own_stage(scene) is None


def test_set_up_twice_there_is_one_stage():
    obj, scene = baked(), bpy.context.scene
    own_camera_and_world(scene)
    staging.set_up(scene, [obj])
    first = {kind: len(names) for kind, names in blocks().items()}
    staging.set_up(scene, [obj])
    assert {kind: len(names) for kind, names in blocks().items()} == first
    staging.strike(scene)
    assert (scene.camera.name, scene.world.name) == ("Mine", "Mine")


def test_around_a_single_point_there_is_no_stage():
    obj = add_curve([np.zeros((3, 3))])
    before = blocks()
    with pytest.raises(CurveError, match="All points of the curves are the same"):
        staging.set_up(bpy.context.scene, [obj])
    assert blocks() == before


def test_neither_camera_nor_world_is_used_unless_asked_for():
    obj, scene = baked(), bpy.context.scene
    own_camera_and_world(scene)
    staging.set_up(scene, [obj], use_camera=False, use_world=False)
    assert (scene.camera.name, scene.world.name) == ("Mine", "Mine")
    assert staging.fits(scene)
    staging.strike(scene)
    assert (scene.camera.name, scene.world.name) == ("Mine", "Mine")


def test_a_camera_chosen_meanwhile_stays():
    obj, scene = baked(), bpy.context.scene
    staging.set_up(scene, [obj])
    own_camera_and_world(scene)
    staging.strike(scene)
    assert (scene.camera.name, scene.world.name) == ("Mine", "Mine")


def test_what_somebody_put_into_the_collection_stays():
    obj, scene = baked(), bpy.context.scene
    prop = bpy.data.objects.new("Prop", None)
    staging.set_up(scene, [obj]).objects.link(prop)
    staging.set_up(scene, [obj])
    staging.strike(scene)
    assert prop.users_collection
    assert prop.name in scene.objects


def test_another_shape_of_the_picture_is_noticed():
    obj, scene = baked(), bpy.context.scene
    assert staging.fits(scene)
    staging.set_up(scene, [obj])
    scene.render.resolution_percentage = 50
    assert staging.fits(scene)
    scene.render.resolution_x *= 2
    assert not staging.fits(scene)


def test_workbench_has_its_light_from_where_the_key_light_is():
    obj, scene = baked(), bpy.context.scene
    assert staging.key_direction(scene) is None
    staging.set_up(scene, [obj])
    bpy.context.view_layer.update()
    ground = stage.Stage.around(WorldMotion.of(scene, [obj]).points, np.array([0.0, 0.0, 1.0]))
    wanted = np.array([-1.6, 0.4, 2.6]) @ ground.axes  # as assets.blend has it
    wanted /= np.linalg.norm(wanted)
    assert np.dot(staging.key_direction(scene), wanted) > 0.98


def test_the_stage_is_no_neighbour_to_be_warned_of():
    obj, scene = baked(), bpy.context.scene
    staging.set_up(scene, [obj])
    bpy.context.view_layer.update()
    assert surroundings.warning(bpy.context, [obj]) is None
