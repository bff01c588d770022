"""The camera sees the whole tube in every frame, and the floor stays below it."""

import bpy
import numpy as np
import pytest
from blender_scenes import drawn
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
from mobius_flow.addon.pictures import film, rendering
from mobius_flow.addon.pictures.looks import LOOKS
from mobius_flow.core.curve import Mesh
from mobius_flow.core.keys.motion import Key, Keys, Playing
from mobius_flow.core.keys.placement import Origin

SIZES = [(640, 360), (360, 640)]


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


def composed(keys, size, origin=None):
    scene = bpy.context.scene
    rendering.use_cycles(scene, LOOKS["PAPER"], *size, 1)
    film.compose(scene, keys, 1.0 + 10 * np.arange(len(keys.keys)), Mesh((40,)), Playing(), origin)
    return scene


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("keys", [1, 2, 12])
@pytest.mark.parametrize("far", [False, True])
def test_all_is_seen_in_every_frame(size, keys, far):
    origin = Origin(np.array([900.0, -500.0, 64.0]), 256.0) if far else None
    scene = composed(tumbling(keys), size, origin)
    obj = bpy.data.objects["Curve"]
    widest = 0.0
    for frame in range(scene.frame_start, scene.frame_end + 1, 3):
        scene.frame_set(frame)
        points = drawn(obj)
        seen = np.array([world_to_camera_view(scene, scene.camera, Vector(p)) for p in points])
        assert seen[:, :2].min() > 0, frame
        assert seen[:, :2].max() < 1, frame
        assert seen[:, 2].min() > scene.camera.data.clip_start
        widest = max(widest, np.ptp(seen[:, :2], axis=0).max())
        floor = bpy.data.objects["Floor"].matrix_world
        up = np.array(floor.to_3x3().normalized()) @ np.cross(*_sides(bpy.data.objects["Floor"]))
        assert ((points - np.array(floor.translation)) @ up).min() > 0, frame
    assert widest > 0.7


def _sides(floor):
    """Two sides of the floor whose cross product is up."""
    a, b, _, d = (np.array(vertex.co) for vertex in floor.data.vertices)
    sides = b - a, d - a
    return [side / np.linalg.norm(side) for side in sides]


def test_around_a_curve_at_rest_the_camera_swings_and_comes_back():
    keys = tumbling(1)
    scene = composed(Keys((keys.keys[0], Key(1.0, keys.keys[0].points)), 0), SIZES[0])
    places = []
    for frame in (1, 3, 11):
        scene.frame_set(frame)
        places.append(np.array(scene.camera.matrix_world.translation))
    np.testing.assert_allclose(places[0], places[2], atol=1e-5)
    assert np.linalg.norm(places[1] - places[0]) > 0.1 * np.linalg.norm(places[0])
    assert bpy.data.objects["Floor"].animation_data is None


def test_the_camera_moves_calmly():
    scene = composed(tumbling(12), SIZES[0])
    ways = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        ways.append(np.array(scene.camera.matrix_world.translation))
    steps = np.linalg.norm(np.diff(ways, axis=0), axis=1)
    assert steps.max() < 0.05 * np.linalg.norm(ways[0])
