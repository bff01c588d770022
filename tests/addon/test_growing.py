"""Curves that grow are keyed: where edges are split on the way, those of earlier keys are split too."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, relax
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.addon.curves.splines import box
from mobius_flow.addon.curves.surroundings import Surroundings
from mobius_flow.addon.live.requirements import avoided
from mobius_flow.core.collision.embedded import clears
from shapes import regular_polygon

SHORT = {"grow": 1.2, "max_iterations": 8}


def add_ring():
    return add_curve([regular_polygon(40).vertices * [1.0, 0.8, 1.0]])


@pytest.mark.parametrize("size", ["LENGTH", "BOX"])
def test_keys_grow_and_are_proved_unless_their_size_is_kept(size):
    obj = add_ring()
    relax(**SHORT, keep_size=size)
    keys = BakedKeys([obj])
    assert keys.unproved == 0
    if size == "LENGTH":
        lengths = [curve.length for curve in keys.curves]
        assert lengths[-1] == pytest.approx(1.2 * lengths[0], rel=1e-3)
    else:
        boxes = [np.ptp(curve.vertices, axis=0).max() for curve in keys.curves]
        np.testing.assert_allclose(boxes, boxes[0], rtol=1e-5)


def add_ball():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=1.3)
    ball = bpy.context.object
    ball.select_set(False)
    bpy.context.scene.mobius_flow_surroundings.container = ball
    return ball


def test_a_curve_is_packed_into_its_container():
    obj, ball = add_ring(), add_ball()
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.curve.mobius_flow_pack(max_iterations=20, vertices=60) == {"FINISHED"}
    keys = BakedKeys([obj])
    lengths = [curve.length for curve in keys.curves]
    assert lengths[-1] > 1.2 * lengths[0]
    assert keys.unproved == 0
    assert clears(keys.curves[-1], Surroundings.of([ball], []).obstacles, 0.0)
    low, high = box(ball)
    assert all((low < each.vertices).all() and (each.vertices < high).all() for each in keys.curves)


def test_what_lies_in_the_container_never_touches_it_whatever_is_pressed():
    obj, ball = add_ring(), add_ball()
    obj.select_set(True)
    assert avoided(bpy.context) == [ball]
    assert avoided(bpy.context, "") == []
    obj.select_set(False)
    assert avoided(bpy.context) == []
    obj.select_set(True)
    ball.hide_set(True)
    assert avoided(bpy.context) == []
    ball.hide_set(False)
    for x in (-2.0, 2.0):
        obj.location.x = x
        bpy.context.view_layer.update()
        assert avoided(bpy.context) == []
