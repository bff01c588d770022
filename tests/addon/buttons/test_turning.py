"""Lay Flat and Face Camera."""

import bpy
import numpy as np
import pytest
from blender_scenes import (
    add_curve,
    add_hopf_link,
    add_trefoil,
    contents,
    evaluated,
    in_world,
    place,
    relax,
    sentence,
    show,
    stored,
)
from mobius_flow.addon.curves import bake
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core import Curve
from shapes import torus_trefoil

OPS = bpy.ops.curve
KEYED = ["SHAPE_KEYS", "FCURVES"]


def extents(obj):
    return np.ptp(in_world(obj, evaluated(obj)), axis=0)


@pytest.mark.parametrize("kind", ["bare", "baked"])
def test_flat_curves_extend_least_upwards(kind):
    obj = add_curve([torus_trefoil(40).vertices[:, [2, 0, 1]]])
    if kind == "baked":
        relax(max_iterations=5)
    place(obj)
    scale, points = obj.scale.copy(), stored(obj.data)
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    x, y, z = extents(obj)
    assert x >= 0.9 * y > z
    np.testing.assert_allclose(obj.scale, scale, rtol=1e-5)
    np.testing.assert_array_equal(stored(obj.data), points)
    rotation = obj.rotation_euler.copy()
    OPS.mobius_flow_lay_flat()
    np.testing.assert_allclose(obj.rotation_euler, rotation, atol=1e-3)


def keyed_rotation(obj):
    for frame in (1, 100):
        obj.rotation_euler.z += 1
        obj.keyframe_insert("rotation_euler", frame=frame)
    bpy.context.scene.frame_set(50)


@pytest.mark.parametrize("keyframes", KEYED)
def test_keys_are_turned_where_the_object_is_animated(keyframes):
    add_curve([torus_trefoil(40).vertices[:, [2, 0, 1]]])
    obj = relax(max_iterations=5, keyframes=keyframes)
    keyed_rotation(obj)
    matrix, lengths = obj.matrix_world.copy(), BakedKeys([obj]).curves
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    assert obj.matrix_world == matrix
    x, y, z = np.ptp(BakedKeys([obj]).frames[-1], axis=0)
    assert x >= 0.9 * y > z
    for old, new in zip(lengths, BakedKeys([obj]).curves, strict=True):
        np.testing.assert_allclose(new.edge_lengths, old.edge_lengths, rtol=1e-4)
    assert not bake.is_edited(obj.data)
    assert BakedKeys([obj]).unproved == 0


def test_edited_keys_are_not_turned_but_their_object_is():
    add_curve([torus_trefoil(40).vertices[:, [2, 0, 1]]])
    obj = relax(max_iterations=3)
    obj.data.shape_keys.key_blocks[1].data[0].co.x += 0.01
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    keyed_rotation(obj)
    before = BakedKeys([obj]).frames
    with pytest.raises(RuntimeError, match="is moved by animation, and its keys were edited; undo one or the other"):
        OPS.mobius_flow_lay_flat()
    np.testing.assert_array_equal(BakedKeys([obj]).frames, before)
    assert bake.is_edited(obj.data)


def test_an_animated_curve_without_keys_is_refused():
    obj = add_trefoil()
    keyed_rotation(obj)
    with pytest.raises(RuntimeError) as error:
        OPS.mobius_flow_lay_flat()
    assert sentence(error.value) == "'Knot' is moved by animation; remove that, or bake it and turn it alone"


def uneven_parent(obj):
    """An empty whose scale shears what is turned under it."""
    parent = show(bpy.data.objects.new("Parent", None))
    parent.rotation_euler, parent.scale = (0.3, 0.5, 1.0), (2.0, 0.5, -1.0)
    obj.parent, obj.rotation_euler = parent, (0.4, 0.0, 0.2)
    parent.select_set(False)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return parent


@pytest.mark.parametrize("keyframes", KEYED)
def test_keys_are_turned_where_the_scale_of_a_parent_would_shear_them(keyframes):
    obj = add_curve([torus_trefoil(40).vertices[:, [2, 0, 1]]])
    uneven_parent(obj)
    relax(max_iterations=5, keyframes=keyframes)
    matrix, before = obj.matrix_world.copy(), BakedKeys([obj]).curves
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    assert obj.matrix_world == matrix
    for old, new in zip(before, BakedKeys([obj]).curves, strict=True):
        np.testing.assert_allclose(new.edge_lengths, old.edge_lengths, rtol=1e-4)
    x, y, z = np.ptp(BakedKeys([obj]).curves[-1].vertices, axis=0)
    assert max(x, y) > z
    assert BakedKeys([obj]).unproved == 0


def test_a_curve_that_its_parent_would_shear_is_refused_without_keys():
    obj = add_trefoil()
    parent = uneven_parent(obj)
    before = contents()
    with pytest.raises(RuntimeError) as error:
        OPS.mobius_flow_lay_flat()
    why = "'Knot' would change its shape, as its parent's scale is uneven"
    assert sentence(error.value) == f"{why}; remove that, or bake it and turn it alone"
    assert contents() == before
    parent.scale = (-2.0, -2.0, -2.0)
    obj.scale = (1.0, 3.0, 0.5)
    bpy.context.view_layer.update()
    lengths = Curve(in_world(obj, evaluated(obj))).edge_lengths
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    np.testing.assert_allclose(Curve(in_world(obj, evaluated(obj))).edge_lengths, lengths, rtol=1e-4)


def test_an_unevenly_scaled_curve_carries_its_child_along():
    parent, obj = add_curve([torus_trefoil(40).vertices], "Parent"), add_curve([torus_trefoil(40).vertices + 9.0])
    parent.scale, obj.parent, obj.rotation_euler = (2.0, 0.5, 1.0), parent, (0.4, 0.5, 0.2)
    parent.select_set(True)
    bpy.context.view_layer.update()
    lengths = Curve(in_world(obj, evaluated(obj))).edge_lengths
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    np.testing.assert_allclose(Curve(in_world(obj, evaluated(obj))).edge_lengths, lengths, rtol=1e-4)


def test_a_single_point_has_no_flat_side():
    add_curve([np.zeros((3, 3))])
    with pytest.raises(RuntimeError, match="All points of the curves are the same; move them apart"):
        OPS.mobius_flow_lay_flat()


def test_links_are_turned_as_one():
    obj = add_hopf_link()
    points = stored(obj.data)
    bpy.data.objects.remove(obj)
    objects = [add_curve([points[:24]], "A"), add_curve([points[24:]], "B")]
    objects[1].parent = objects[0]
    objects[0].location, objects[0].rotation_euler = (1, 2, 3), (0.5, 0.6, 0.7)
    for each in objects:
        each.select_set(True)
    bpy.context.view_layer.update()

    def gaps():
        a, b = (in_world(each, evaluated(each)) for each in objects)
        return np.linalg.norm(a[:, None] - b[None], axis=2)

    before = gaps()
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    np.testing.assert_allclose(gaps(), before, atol=1e-5)
    x, y, z = np.ptp(np.concatenate([in_world(each, evaluated(each)) for each in objects]), axis=0)
    assert x > y - 1e-4
    assert y > z - 1e-4


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_the_camera_sees_the_widest_side(kind):
    obj = add_curve([torus_trefoil(40).vertices * np.array([2.0, 1.0, 1.0])])
    place(obj)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type = kind
    camera.location, camera.rotation_euler = (9, -4, 6), (1.0, 0.1, 1.1)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.context.view_layer.update()
    assert OPS.mobius_flow_face_camera() == {"FINISHED"}
    curve = Curve(in_world(obj, evaluated(obj)))
    center = curve.edge_lengths @ curve.midpoints / curve.length
    axes = np.array(camera.matrix_world)[:3, :3].T
    back = axes[2] if kind == "ORTHO" else np.array(camera.location) - center
    right = axes[0] - (axes[0] @ back) * back / (back @ back)
    away = curve.midpoints - center
    moments = (curve.edge_lengths[:, None] * away).T @ away
    directions = [each / np.linalg.norm(each) for each in (right, np.cross(back, right), back)]
    seen = np.array([[a @ moments @ b for a in directions] for b in directions])
    assert seen[0, 0] > seen[1, 1] > seen[2, 2]
    np.testing.assert_allclose(seen - np.diag(np.diag(seen)), 0, atol=1e-4 * seen[0, 0])


def test_without_a_camera_there_is_nothing_to_face():
    add_trefoil()
    with pytest.raises(RuntimeError, match="The scene has no camera; add one first"):
        OPS.mobius_flow_face_camera()
