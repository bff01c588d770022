"""Since 4.4 Blender puts keys of an object into the action of its curve: either is left alone when the other goes."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, relax, stored
from mobius_flow.addon.curves import bake
from mobius_flow.addon.curves.moving import what_moves


@pytest.fixture(params=["SHAPE_KEYS", "FCURVES"])
def turning(request):
    """A baked curve on an object that turns."""
    obj = add_trefoil()
    relax(max_iterations=3, keyframes=request.param)
    for frame, angle in ((1, 0.0), (100, 2.0)):
        obj.rotation_euler.z = angle
        obj.keyframe_insert("rotation_euler", frame=frame)
    return obj


def angle(frame):
    bpy.context.scene.frame_set(frame)
    return bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get()).rotation_euler.z


def test_a_curve_on_a_turning_object_is_baked_still(turning):
    assert bake.is_baked(turning.data)
    assert what_moves(turning) == "animation"


@pytest.mark.parametrize("operator", ["bake_again", "continue"])
def test_it_is_baked_again_and_the_object_goes_on_turning(turning, operator):
    options = {"max_iterations": 2, "fit_bevel": False}
    for _ in range(2):
        assert getattr(bpy.ops.curve, f"mobius_flow_{operator}")(**options) == {"FINISHED"}
        assert bake.is_baked(turning.data)
        assert angle(100) == pytest.approx(2.0)
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert angle(100) == pytest.approx(2.0)


def test_it_is_cleared_and_nothing_of_it_stays(turning):
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert len(turning.data.splines[0].points) == 30
    assert angle(100) == pytest.approx(2.0)
    (action,) = bpy.data.actions
    for slot in getattr(action, "slots", ()):
        assert slot.target_id_type == "OBJECT"
    before = stored(turning.data)
    bpy.context.scene.frame_set(1)
    np.testing.assert_array_equal(stored(turning.data), before)


def test_a_curve_next_to_a_turning_one_does_not_move(turning):
    """Their actions are one where somebody has chosen so."""
    still = bpy.data.objects.new("Still", None)
    bpy.context.scene.collection.objects.link(still)
    still.animation_data_create().action = turning.animation_data.action
    if hasattr(turning.animation_data.action, "slots"):
        slots = still.animation_data.action.slots
        still.animation_data.action_slot = slots.new(id_type="OBJECT", name="Still")
        assert what_moves(still) is None
