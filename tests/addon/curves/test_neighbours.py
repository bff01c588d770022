"""What is not relaxed stays as it is, and is named: other objects, animation that is there already, other files."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, fcurves, relax, show, stored
from mathutils import Euler
from mobius_flow.addon.curves.surroundings import warning
from shapes import regular_polygon


def keyed(block):
    """All numbers of a datablock's F-curves."""
    return [(curve.data_path, [tuple(point.co) for point in curve.keyframe_points]) for curve in fcurves(block)]


def test_what_is_not_selected_stays():
    other = add_hopf_link()
    other.select_set(False)
    before = stored(other.data)
    obj = add_trefoil()
    moving = stored(obj.data)
    relax(max_iterations=3)
    np.testing.assert_array_equal(stored(other.data), before)
    assert other.data.shape_keys is None
    assert stored(obj.data).shape != moving.shape or not np.array_equal(stored(obj.data), moving)


def test_the_objects_own_animation_stays():
    obj = add_trefoil()
    for frame, x in ((1, 0.0), (20, 3.0)):
        obj.location.x = x
        obj.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(1)
    before = keyed(obj)
    relax(max_iterations=3)
    assert keyed(obj) == before
    bpy.context.scene.frame_set(20)
    assert obj.location.x == pytest.approx(3.0)


def box(name, place, visible=True):
    """An unselected mesh object with a corner at the origin and another at (1, 1, 1)."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([(0, 0, 0), (1, 1, 1)], [(0, 1)], [])
    obj = show(bpy.data.objects.new(name, data))
    obj.location = place
    obj.select_set(False)
    obj.hide_set(not visible)
    return obj


def said(*objects):
    bpy.context.view_layer.update()
    return warning(bpy.context, objects)


def test_what_is_near_is_named():
    obj = add_curve([regular_polygon(20).vertices])
    assert said(obj) is None
    far = box("Far", (3, 0, 0))
    assert said(obj) is None
    near = box("Near", (1.1, 0, 0))
    assert said(obj) == "'Near' nearby is neither selected nor avoided, and may be crossed"
    obj.location.x = 2
    assert said(obj) == "'Far' and 'Near' nearby are neither selected nor avoided, and may be crossed"
    assert said(obj, far) == "'Near' nearby is neither selected nor avoided, and may be crossed"
    assert said(obj, far, near) is None


def test_many_are_counted():
    obj = add_curve([regular_polygon(20).vertices])
    for k in range(9):
        box(f"Box {k}", (0, 0, 0))
    assert said(obj).startswith("'Box 0', 'Box 1', 'Box 2' and 6 more nearby are neither")


def test_only_what_is_seen_and_solid_is_named():
    obj = add_curve([regular_polygon(20).vertices])
    box("Hidden", (0, 0, 0), visible=False)
    show(bpy.data.objects.new("Empty", None))
    show(bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")))
    assert said(obj) is None


def test_boxes_are_those_in_the_world():
    obj = add_curve([regular_polygon(20).vertices])
    other = box("Turned", (5, 0, 0))
    other.scale = (6, 1, 1)
    assert said(obj) is None
    other.rotation_euler = Euler((0, 0, np.pi))
    assert "'Turned'" in said(obj)
