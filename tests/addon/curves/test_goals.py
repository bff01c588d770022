"""In a morph splines change to the materials of what they become, at the keys that reach it."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve
from mobius_flow import Relaxation
from mobius_flow.addon.curves import bake
from mobius_flow.addon.curves.keyframes import fcurves_of
from mobius_flow.core.keys.key_options import Timing

SHORT = {"vertices": 12, "length": 31, "untangle": "never", "radius": "none"}
RECTANGLE = np.array([(0.0, 0, 0), (3, 0, 0.3), (3, 1, 0), (0, 1, 0.3)])  # not flat, which takes exact decisions
ZIGZAG = np.array([(0.0, 0, 0), (1, 0, 0.5), (2, 0, 0), (2, 2, -0.5), (1, 1, -1), (0, 2, 0)])
FAR = np.array([9.0, 0, 0])


def painted(components, *materials):
    obj = add_curve(components)
    for k, each in enumerate(materials):
        obj.data.materials.append(each)
        obj.data.splines[k].material_index = k
    return obj


@pytest.fixture
def red():
    return bpy.data.materials.new("Red")


@pytest.fixture
def blue():
    return bpy.data.materials.new("Blue")


def worn(obj, frame):
    """What the faces of the tubes of all splines are drawn in at a frame, one after the other."""
    bpy.context.scene.frame_set(frame)
    obj.data.bevel_depth = 0.01
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    found = dict.fromkeys(face.material_index for face in shown.to_mesh().polygons)
    shown.to_mesh_clear()
    return [getattr(obj.data.materials[k], "name", None) for k in found]


def test_keys_change_materials_and_clear_gives_its_own_back(red, blue):
    moving, there = painted([RECTANGLE], red), painted([ZIGZAG + FAR], blue)
    Relaxation(moving).morph(there, add_curve([RECTANGLE - FAR]), **SHORT)
    (curve,) = fcurves_of(moving.data)
    middle = int(np.ceil(curve.keyframe_points[1].co[0]))
    assert 1 < middle < 31
    frames = [1, middle - 1, middle, 30, 31]
    assert [worn(moving, frame) for frame in frames] == [["Red"], ["Red"], ["Blue"], ["Blue"], [None]]
    assert bake.is_baked(moving.data)

    Relaxation(moving).clear()
    assert [*moving.data.materials] == [red]
    assert moving.data.splines[0].material_index == 0
    assert not bpy.data.actions


def test_a_loop_changes_back(red, blue):
    moving = painted([RECTANGLE], red)
    Relaxation(moving).morph(painted([ZIGZAG], blue), loop=True, **SHORT | {"length": 60})
    assert [worn(moving, frame) for frame in (1, 31, 60, 61)] == [["Red"], ["Blue"], ["Blue"], ["Red"]]


def test_materials_change_with_the_timing_and_stay_when_it_continues(red, blue):
    moving = painted([RECTANGLE], red)
    Relaxation(moving).morph(painted([ZIGZAG], blue), **SHORT)
    assert bake.retime(moving.data, Timing(length=11))
    assert [worn(moving, frame) for frame in (1, 10, 11)] == [["Red"], ["Red"], ["Blue"]]
    assert Relaxation(moving).relax_further(max_iterations=2, length=10, fit_bevel=False).certified
    assert [worn(moving, frame) for frame in (1, 11, 20)] == [["Red"], ["Blue"], ["Blue"]]


def test_each_spline_takes_on_that_of_the_one_it_becomes(red, blue):
    """A large ring and a small one are linked, and come in the other order in what they become."""
    angles = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    large = np.stack([2.0 * np.cos(angles), 2.0 * np.sin(angles), 0.1 * np.sin(2 * angles)], axis=1)
    small = np.stack([2.0 + 0.5 * np.cos(angles), 0.1 * np.sin(2 * angles), 0.5 * np.sin(angles)], axis=1)
    moving = painted([large, small], red, blue)
    there = painted([small + FAR, large + FAR], blue, red)
    Relaxation(moving).morph(there, **SHORT | {"vertices": 24})
    assert [*moving.data.materials] == [red, blue]
    there.data.splines[0].material_index, there.data.splines[1].material_index = 1, 0
    Relaxation(moving).morph(there, **SHORT | {"vertices": 24})
    assert [worn(moving, frame) for frame in (1, 30, 31)] == [["Red", "Blue"], ["Red", "Blue"], ["Blue", "Red"]]


def test_baking_again_takes_them_off(red, blue):
    moving = painted([RECTANGLE], red)
    Relaxation(moving).morph(painted([ZIGZAG], blue), **SHORT)
    Relaxation(moving).relax(**SHORT)
    assert [*moving.data.materials] == [red]
