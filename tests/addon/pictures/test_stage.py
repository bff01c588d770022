"""A stage, in a film or in an artist's scene: all is in sight, above the floor; what was there comes back."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, drawn, relax
from bpy_extras.object_utils import world_to_camera_view
from families import crossed
from mathutils import Vector
from mobius_flow.addon.curves import surroundings
from mobius_flow.addon.curves.recorded import world_motion
from mobius_flow.addon.curves.splines import new_curve_data, write_points
from mobius_flow.addon.pictures import export, rendering, stage, staging
from mobius_flow.addon.pictures.looks import LOOKS
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.curve import Mesh
from mobius_flow.core.keys.key_options import Playing
from mobius_flow.core.keys.placement import Origin
from mobius_flow.core.keys.recording import Key, Keys
from mobius_flow.core.knots import knot
from shapes import lattice_knot

SIZES = [(640, 360), (360, 640)]
KINDS = ("objects", "cameras", "lights", "meshes", "materials", "worlds", "collections", "actions")


def see(scene, objects, frames):
    """Check that the camera sees all of some objects, which stay above the floor; the largest part of the picture."""
    (floor,) = [obj for obj in scene.objects if obj.name.startswith("Floor")]
    widest = 0.0
    for frame in frames:
        scene.frame_set(frame)
        points = np.concatenate([drawn(obj) for obj in objects])
        seen = np.array([world_to_camera_view(scene, scene.camera, Vector(point)) for point in points])
        assert seen[:, :2].min() > 0, frame
        assert seen[:, :2].max() < 1, frame
        assert seen[:, 2].min() > scene.camera.data.clip_start
        a, b, _, d = (np.array(floor.matrix_world @ vertex.co) for vertex in floor.data.vertices)
        assert ((points - np.array(floor.matrix_world.translation)) @ np.cross(b - a, d - a)).min() > 0, frame
        widest = max(widest, np.ptp(seen[:, :2], axis=0).max())
    return widest


# -- in a film -------------------------------------------------------------------------------------------------------


def tumbling(keys):
    """An ellipse that turns, grows and shrinks, from key to key by leaps."""
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    frames = []
    for k in range(keys):
        a = 0.9 * k
        ellipse = np.stack([2 * np.cos(t), np.sin(t), 0.3 * np.sin(2 * t)], axis=1) * (1 + 0.8 * np.sin(1.7 * k))
        turn = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
        frames.append(Key(float(k), (ellipse @ turn).astype(np.float32)))
    return Keys(tuple(frames), 0)


def composed(keys, size=SIZES[0], origin=None):
    scene = bpy.context.scene
    rendering.use_cycles(scene, LOOKS["PAPER"], *size, 1)
    export.compose(scene, keys, 1.0 + 10 * np.arange(len(keys.keys)), Mesh((40,)), Playing(), origin)
    return scene


def places_of_the_camera(scene, frames):
    for frame in frames:
        scene.frame_set(frame)
        yield np.array(scene.camera.matrix_world.translation)


@pytest.mark.parametrize(("size", "keys", "far"), crossed(SIZES, [1, 2, 12], [False, True]))
def test_all_is_seen_in_every_frame_of_a_film(size, keys, far):
    scene = composed(tumbling(keys), size, Origin(np.array([900.0, -500.0, 64.0]), 256.0) if far else None)
    frames = range(scene.frame_start, scene.frame_end + 1, 3)
    assert see(scene, [bpy.data.objects["Curve"]], frames) > 0.69


def test_around_a_curve_at_rest_the_camera_swings_and_comes_back():
    (key,) = tumbling(1).keys
    scene = composed(Keys((key, Key(1.0, key.points)), 0))
    first, middle, last = places_of_the_camera(scene, (1, 3, 11))
    np.testing.assert_allclose(first, last, atol=1e-5)
    assert np.linalg.norm(middle - first) > 0.1 * np.linalg.norm(first)
    assert bpy.data.objects["Floor"].animation_data is None


def test_the_camera_moves_calmly():
    scene = composed(tumbling(12))
    ways = list(places_of_the_camera(scene, range(scene.frame_start, scene.frame_end + 1)))
    assert np.linalg.norm(np.diff(ways, axis=0), axis=1).max() < 0.05 * np.linalg.norm(ways[0])


# -- in a scene ------------------------------------------------------------------------------------------------------


def blocks():
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in KINDS}


def own_camera_and_world(scene):
    scene.camera = bpy.data.objects.new("Mine", bpy.data.cameras.new("Mine"))
    scene.collection.objects.link(scene.camera)
    scene.world = bpy.data.worlds.new("Mine")


def used(scene):
    return scene.camera.name, scene.world.name


def baked(**options):
    add_curve([lattice_knot("4_1").vertices])
    obj = relax(**{"max_iterations": 8, "vertices": 120} | options)
    obj.data.bevel_depth = 0.1
    return obj


@pytest.fixture
def scene():
    return bpy.context.scene


@pytest.mark.parametrize("size", SIZES)
def test_the_whole_animation_is_in_sight(scene, size):
    obj = baked()
    obj.location, obj.rotation_euler, obj.scale = (30, -20, 5), (0.3, 0.2, 0.1), (2, 1, 0.5)
    bpy.context.view_layer.update()
    scene.render.resolution_x, scene.render.resolution_y = size
    staging.set_up(scene, [obj])
    assert see(scene, [obj], range(1, 10)) > 0.5


def test_an_object_that_something_moves_is_in_sight(scene):
    obj = baked()
    for frame, place in ((1, (0, 0, 0)), (40, (60, 0, 9))):
        obj.location = place
        obj.keyframe_insert("location", frame=frame)
    scene.frame_end = 40
    scene.frame_set(17, subframe=0.5)
    staging.set_up(scene, [obj])
    assert (scene.frame_current, scene.frame_subframe) == (17, 0.5)
    see(scene, [obj], range(1, 41, 3))


def test_the_floor_is_level_and_the_curve_lies_across_the_picture():
    points = np.random.default_rng(3).normal(size=(40, 3)) * [1, 9, 3]
    axes, elevation = stage.facing([points], np.array([0.0, 0.0, 1.0]))
    assert 0.6 < elevation < 1.2
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0
    np.testing.assert_allclose(axes[2], [0, 0, 1])
    assert np.ptp(points @ axes[0]) > 2 * np.ptp(points @ axes[1])


def test_your_own_camera_and_world_are_only_put_aside(scene, tmp_path):
    obj = baked()
    own_camera_and_world(scene)
    before = blocks()
    staging.set_up(scene, [obj], use_camera=False, use_world=False)
    assert used(scene) == ("Mine", "Mine")
    assert staging.fits(scene)
    staging.set_up(scene, [obj])
    first = {kind: len(names) for kind, names in blocks().items()}
    staging.set_up(scene, [obj])
    assert {kind: len(names) for kind, names in blocks().items()} == first, "there is one stage"
    assert "Mine" not in used(scene)
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    staging.strike(bpy.context.scene)
    assert used(bpy.context.scene) == ("Mine", "Mine")
    assert blocks() == before
    assert staging.own_stage(bpy.context.scene) is None


def test_what_somebody_chose_or_put_there_meanwhile_stays(scene):
    obj, prop = baked(), bpy.data.objects.new("Prop", None)
    staging.set_up(scene, [obj]).objects.link(prop)
    staging.set_up(scene, [obj])
    own_camera_and_world(scene)
    staging.strike(scene)
    assert used(scene) == ("Mine", "Mine")
    assert prop.name in scene.objects


def test_around_a_single_point_there_is_no_stage(scene):
    obj = add_curve([np.zeros((3, 3))])
    before = blocks()
    with pytest.raises(CurveError, match="All points of the curves are the same"):
        staging.set_up(scene, [obj])
    assert blocks() == before


def test_another_shape_of_the_picture_is_noticed(scene):
    obj = baked()
    assert staging.fits(scene)
    staging.set_up(scene, [obj])
    scene.render.resolution_percentage = 50
    assert staging.fits(scene)
    scene.render.resolution_x *= 2
    assert not staging.fits(scene)


def test_a_stage_looks_at_the_knot_of_a_rope_and_is_below_its_ends(scene):
    rope = knot("bowline", 100)
    ends = rope.vertices[[0, -1]] + 60.0 * (rope.vertices[[0, -1]] - rope.vertices[[1, -2]]) - [0.0, 0.0, 30.0]
    longer = Curve.from_components([np.concatenate([ends[:1], rope.vertices, ends[1:]])], [False])
    data = new_curve_data("Rope", longer.mesh)
    write_points(data, longer.vertices)
    obj = bpy.data.objects.new("Rope", data)
    scene.collection.objects.link(obj)
    collection = staging.set_up(scene, [obj])
    bpy.context.view_layer.update()
    place = {each.name.partition(".")[0]: each.matrix_world.translation for each in collection.objects}
    assert place["Floor"].z < longer.vertices[:, 2].min() + 1e-3
    assert (place["Camera"] - place["Focus"]).length < 1.2 * np.linalg.norm(np.ptp(longer.vertices, axis=0))


def test_workbench_has_its_light_from_where_the_key_light_is(scene):
    obj = baked()
    collection = staging.set_up(scene, [obj])
    bpy.context.view_layer.update()
    ground = stage.Ground.around(world_motion(scene, [obj])[1], np.array([0.0, 0.0, 1.0]))
    wanted = np.array([-1.6, 0.4, 2.6]) @ ground.axes  # as assets.blend has it
    stage.light_workbench(scene, collection)
    right, up, back = scene.display.light_direction
    assert np.dot([right, -back, up], wanted) > 0.98 * np.linalg.norm(wanted)
    assert surroundings.warning(bpy.context, [obj]) is None, "the stage is no neighbour to be warned of"
