"""Morph to Active: the selected curve becomes the active one, keyed and proved as a relaxation is."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, stored
from mathutils import Vector
from mobius_flow import Relaxation
from mobius_flow.addon.curves import bake, surroundings
from mobius_flow.addon.scripting import begin
from mobius_flow.core import MobiusFlowError
from mobius_flow.core.knots import knot

SHORT = {"vertices": 12, "length": 30, "untangle": "never", "radius": "none", "timing": "DISTANCE"}
RECTANGLE = [(0.0, 0, 0), (3, 0, 0.3), (3, 1, 0), (0, 1, 0.3)]  # not flat, which takes exact decisions
ZIGZAG = [(0.0, 0, 0), (1, 0, 0.5), (2, 0, 0), (2, 2, -0.5), (1, 1, -1), (0, 2, 0)]


def test_the_selected_curve_becomes_the_active_one():
    goal = add_curve([ZIGZAG])
    goal.location, goal.scale = (5, 6, 7), (2, 2, 2)
    moving = add_curve([RECTANGLE])
    moving.location = (1, 0, 0)
    moving.select_set(True)
    goal.select_set(True)
    bpy.context.view_layer.objects.active = goal
    before = stored(goal.data)
    assert bpy.ops.curve.mobius_flow_morph(**SHORT) == {"FINISHED"}
    assert bake.scene_range([moving]) == (1, 30)
    np.testing.assert_array_equal(stored(goal.data), before)
    assert (goal.hide_get(), goal.hide_render, moving.visible_get()) == (True, True, True), "both are in one place"
    assert (bpy.context.selected_objects, bpy.context.active_object) == ([moving], moving)
    curves = Relaxation(moving).curves
    first, last = ({tuple(np.round(p, 4)) for p in each.vertices.tolist()} for each in (curves[0], curves[-1]))
    assert {(x + 1.0, y, z) for x, y, z in RECTANGLE} <= first
    assert {(5 + 2 * x, 6 + 2 * y, 7 + 2 * z) for x, y, z in ZIGZAG} <= last


def test_its_goal_is_nothing_to_be_warned_of(operator):
    moving, goal = add_curve([RECTANGLE]), add_curve([ZIGZAG])
    operator.session = lambda _context, values: begin([moving], values, False, True, [goal])
    operator.start()
    assert goal.name in surroundings.warning(bpy.context, operator.run.session.objects)
    assert surroundings.warning(bpy.context, operator.run.objects) is None


def test_a_script_goes_over_several_and_says_what_it_proved():
    objects = [add_curve([RECTANGLE]), add_curve([ZIGZAG]), add_curve([RECTANGLE])]
    objects[2].location = (0, 0, 4)
    report = Relaxation(objects[0]).morph(*objects[1:], **SHORT)
    assert report.certified
    assert "met" in report.sentence
    assert report.scene_range == (1, 30)


def test_what_cannot_be_is_said_and_nothing_changes():
    moving, goal = (add_curve([knot(name).vertices.tolist()]) for name in ("3_1", "m3_1"))
    told = f"the curve that moves is 3_1, '{goal.name}' its mirror image m3_1: .*signatures −2 and 2"
    with pytest.raises(MobiusFlowError, match=told):
        Relaxation(moving).morph(goal, **SHORT | {"vertices": 60})
    assert not moving.data.shape_keys
    moving.select_set(True)
    goal.select_set(False)
    with pytest.raises(RuntimeError, match="Select a curve, and then the one that it is to become"):
        bpy.ops.curve.mobius_flow_morph()


def test_what_is_wrong_with_a_goal_is_said_of_its_splines():
    moving, goal = add_curve([RECTANGLE]), add_curve([[(0.0, 0, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)]])
    name = goal.name
    told = f"^Segment 1 of spline 1 of '{name}' and segment 3 of spline 1 of '{name}' touch"
    with pytest.raises(MobiusFlowError, match=told):
        Relaxation(moving).morph(goal, **SHORT)


def test_ends_that_are_in_one_place_but_for_rounding_are_held_there():
    moving, goal = (add_curve([ZIGZAG], cyclic=False) for _ in range(2))
    goal.location, goal.rotation_euler.z = (0.1, 0.2, 0.3), 0.7
    bpy.context.view_layer.update()
    away = goal.matrix_world.inverted()
    for point, place in zip(goal.data.splines[0].points, ZIGZAG, strict=True):
        point.co = (*(away @ Vector(place)), 1.0)
    goal.data.splines[0].points[2].co.z += 0.5
    assert Relaxation(moving).morph(goal, **SHORT).certified
