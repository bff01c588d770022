"""Buttons of the panel Shape: size, attitude, balance, minimum or saddle."""

from itertools import pairwise

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import (  # noqa: E402
    add_curve,
    add_hopf_link,
    add_trefoil,
    contents,
    evaluated,
    fcurves,
    in_world,
    relax,
    sentence,
    show,
    stored,
)
from mobius_flow.addon.buttons import shape  # noqa: E402
from mobius_flow.addon.curves import bake, baked_keys  # noqa: E402
from mobius_flow.addon.curves.baked_keys import BakedKeys  # noqa: E402
from mobius_flow.addon.engine.size import Measure  # noqa: E402
from mobius_flow.core import Curve, RelaxOptions, minimize  # noqa: E402
from mobius_flow.core.collision import is_free  # noqa: E402
from mobius_flow.core.curve.bending import bending  # noqa: E402
from mobius_flow.core.knots import torus_knot  # noqa: E402
from shapes import lattice_knot, torus_trefoil  # noqa: E402

OPS = bpy.ops.curve
KEYED = ["SHAPE_KEYS", "FCURVES"]
MEASURES = [measure.name for measure in Measure]


def baked(keyframes="SHAPE_KEYS", **options):
    """A lattice figure-eight knot that shrinks as seen on the screen."""
    add_curve([lattice_knot("4_1").vertices])
    return relax(**{"max_iterations": 8, "vertices": 120, "keyframes": keyframes} | options)


def place(obj):
    obj.location, obj.rotation_euler, obj.scale = (1, 2, 3), (0.3, 0.2, 0.1), (2, 1, 0.5)
    bpy.context.view_layer.update()


def shown(obj, frames):
    """The world's curve at some frames."""
    return [Curve(in_world(obj, evaluated(obj, frame))) for frame in frames]


def frames_of(obj):
    owner = obj.data.shape_keys or obj.data
    first, last = owner.animation_data.action.curve_frame_range
    return np.linspace(first, last, 5)


def extents(obj):
    return np.ptp(in_world(obj, evaluated(obj)), axis=0)


# -- size


@pytest.mark.parametrize("keyframes", KEYED)
@pytest.mark.parametrize("measure", MEASURES)
def test_a_size_stays(keyframes, measure):
    obj = baked(keyframes)
    place(obj)
    before = shown(obj, frames_of(obj))
    assert OPS.mobius_flow_keep_size(measure=measure) == {"FINISHED"}
    after, measured = shown(obj, frames_of(obj)), Measure[measure].of
    np.testing.assert_allclose(after[0].vertices, before[0].vertices, atol=1e-5)
    sizes = [measured(curve) for curve in BakedKeys([obj]).curves]
    np.testing.assert_allclose(sizes, measured(before[0]), rtol=1e-5)
    for a, b in zip(before, after, strict=True):
        centers = [curve.edge_lengths @ curve.midpoints / curve.length for curve in (a, b)]
        assert np.linalg.norm(centers[1] - centers[0]) < 0.05 * measured(before[0])


@pytest.mark.parametrize("keyframes", KEYED)
def test_the_size_of_the_last_key(keyframes):
    obj = baked(keyframes)
    end = BakedKeys([obj]).curves[-1]
    assert OPS.mobius_flow_keep_size(measure="RADIUS", reference="LAST") == {"FINISHED"}
    curves = BakedKeys([obj]).curves
    np.testing.assert_allclose(curves[-1].vertices, end.vertices, rtol=1e-6)
    np.testing.assert_allclose([Measure.RADIUS.of(c) for c in curves], Measure.RADIUS.of(end), rtol=1e-5)
    if keyframes == "SHAPE_KEYS":  # F-curves move the points themselves
        np.testing.assert_array_equal(stored(obj.data), BakedKeys([obj]).frames[-1])


@pytest.mark.parametrize("keyframes", KEYED)
def test_scaled_keys_are_proved_as_they_are_stored(keyframes):
    obj = baked(keyframes)
    OPS.mobius_flow_keep_size(measure="BOX")
    keys = BakedKeys([obj])
    assert keys.unproved == 0
    for a, b in pairwise(keys.frames):
        assert is_free(keys.mesh, a.astype(float), b.astype(float))


def test_motions_that_cannot_be_proved_are_told_of(monkeypatch):
    obj, told = baked(), []
    monkeypatch.setattr(baked_keys, "is_free", lambda *_: False)
    monkeypatch.setattr(shape, "_tell", lambda _, what, unproved: told.append((what, unproved)))
    assert OPS.mobius_flow_keep_size(measure="BOX") == {"FINISHED"}
    count = len(obj.data.shape_keys.key_blocks)
    assert told == [(f"The bounding box of 'Knot' stays at all {count} keys", count - 1)]


class Teller:
    def report(self, *words):
        self.words = words


def test_words_about_proofs():
    teller = Teller()
    shape._tell(teller, "It stays", 0)
    assert teller.words == ({"INFO"}, "It stays, proved free of contact")
    shape._tell(teller, "It stays", 2)
    assert teller.words == ({"WARNING"}, "It stays; 2 motions between keys are NOT proved free of contact")


@pytest.mark.parametrize("keyframes", KEYED)
def test_scaled_curves_are_still_baked_and_can_be_cleared(keyframes):
    obj = add_trefoil()
    before = stored(obj.data)
    obj.data.bevel_depth = 0.1
    relax(max_iterations=4, keyframes=keyframes, fit_bevel=True)
    assert OPS.mobius_flow_keep_size(measure="BOX") == {"FINISHED"}
    assert bake.is_baked(obj.data)
    assert not bake.is_edited(obj.data)
    assert OPS.mobius_flow_continue(max_iterations=2, fit_bevel=False) == {"FINISHED"}
    assert OPS.mobius_flow_clear() == {"FINISHED"}
    np.testing.assert_array_equal(stored(obj.data), before)
    assert obj.data.bevel_depth == pytest.approx(0.1)


def test_the_tube_is_scaled_with_the_curve():
    obj = baked(fit_bevel=True)
    blocks = obj.data.shape_keys.key_blocks
    radii = [block.data[0].radius for block in blocks]
    lengths = [curve.length for curve in BakedKeys([obj]).curves]
    OPS.mobius_flow_keep_size(measure="BOX")
    factors = [curve.length / old for curve, old in zip(BakedKeys([obj]).curves, lengths, strict=True)]
    np.testing.assert_allclose([block.data[0].radius for block in blocks], np.multiply(radii, factors), rtol=1e-4)


@pytest.mark.parametrize("keyframes", [*KEYED, "RESULT"])
@pytest.mark.parametrize("measure", ["BOX", "RADIUS"])
def test_a_size_stays_while_it_is_baked(keyframes, measure):
    start = add_curve([lattice_knot("4_1").vertices])
    size = Measure[measure].of(Curve(stored(start.data).astype(float)))
    obj = relax(max_iterations=8, vertices=120, keyframes=keyframes, keep_size=measure)
    curves = [Curve(stored(obj.data).astype(float))] if keyframes == "RESULT" else BakedKeys([obj]).curves
    np.testing.assert_allclose([Measure[measure].of(curve) for curve in curves], size, rtol=1e-5)
    if keyframes != "RESULT":
        assert BakedKeys([obj]).unproved == 0


def test_the_length_is_what_the_flow_keeps_bit_for_bit():
    points = []
    for options in ({}, {"keep_size": "LENGTH"}):
        obj = baked(**options)
        points.append(BakedKeys([obj]).frames)
        obj.select_set(False)
    np.testing.assert_array_equal(*points)


def test_a_size_that_was_kept_is_kept_on():
    obj = baked(keep_size="BOX")
    size = Measure.BOX.of(BakedKeys([obj]).curves[0])
    assert OPS.mobius_flow_continue(max_iterations=5, keep_size="BOX", fit_bevel=False) == {"FINISHED"}
    np.testing.assert_allclose([Measure.BOX.of(c) for c in BakedKeys([obj]).curves], size, rtol=1e-5)


def test_links_are_scaled_together():
    first = add_hopf_link()
    points = stored(first.data)
    bpy.data.objects.remove(first)
    objects = [add_curve([points[:24]], "A"), add_curve([points[24:] * 2], "B")]
    objects[1].scale = (0.5, 0.5, 0.5)
    for obj in objects:
        obj.select_set(True)
    relax(max_iterations=5)
    size = Measure.RADIUS.of(BakedKeys(objects).curves[0])
    assert OPS.mobius_flow_keep_size(measure="RADIUS") == {"FINISHED"}
    keys = BakedKeys(objects)
    np.testing.assert_allclose([Measure.RADIUS.of(curve) for curve in keys.curves], size, rtol=1e-5)
    assert keys.unproved == 0


def test_curves_that_were_baked_apart_are_refused():
    one = baked()
    one.select_set(False)
    two = add_trefoil()
    relax(max_iterations=2)
    one.select_set(True)
    before = contents()
    with pytest.raises(RuntimeError) as error:
        OPS.mobius_flow_keep_size()
    assert "were not baked together; select one of them at a time" in sentence(error.value)
    assert contents() == before
    assert {one, two} == set(bpy.context.selected_objects)


def test_without_keys_there_is_nothing_to_scale():
    add_trefoil()
    with pytest.raises(RuntimeError, match="has no keys of Möbius Flow; press Relax first"):
        OPS.mobius_flow_keep_size()


def test_edited_keys_are_left_alone():
    obj = baked()
    obj.data.shape_keys.key_blocks[2].data[0].co.x += 1
    before = BakedKeys([obj]).frames
    with pytest.raises(RuntimeError, match="were edited"):
        OPS.mobius_flow_keep_size()
    np.testing.assert_array_equal(BakedKeys([obj]).frames, before)


def test_f_curves_with_keys_removed_are_refused():
    obj = baked("FCURVES")
    points = fcurves(obj.data)[0].keyframe_points
    points.remove(points[1])
    with pytest.raises(RuntimeError, match="were edited; undo that, or Bake Again"):
        OPS.mobius_flow_keep_size()


# -- attitude


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


# -- balance, minimum or saddle


def test_a_balanced_curve_goes_on_from_its_animation():
    curve = minimize(torus_knot(2, 3, 100), RelaxOptions(vertices=100)).curve
    away = curve.vertices - np.array([0.9, 0.4, 0.9])  # an inversion near the knot
    add_curve([3 * away / np.square(away).sum(axis=1, keepdims=True)])
    obj = relax(vertices=100)
    keys = BakedKeys([obj])
    there, unbalanced = len(keys.frames), bending(keys.curves[-1])
    assert OPS.mobius_flow_balance(fit_bevel=False) == {"FINISHED"}
    keys = BakedKeys([obj])
    assert len(keys.frames) > there + 5, "the way has keys"
    assert keys.unproved == 0
    assert bending(keys.curves[-1]) < 0.95 * unbalanced
    assert not bpy.context.scene.mobius_flow.balance


def saddle():
    add_curve([torus_knot(3, 4, 120).vertices])
    return relax(vertices=120)


def test_a_saddle_is_told_and_left():
    obj = saddle()
    before = contents()
    assert OPS.mobius_flow_check() == {"FINISHED"}
    assert contents() == before
    there = len(BakedKeys([obj]).frames)
    assert OPS.mobius_flow_leave_saddle(fit_bevel=False) == {"FINISHED"}
    assert len(BakedKeys([obj]).frames) > there + 5
    before = contents()
    assert OPS.mobius_flow_leave_saddle() == {"CANCELLED"}, "it is a minimum now"
    assert contents() == before


@pytest.mark.parametrize("name", ["balance", "check", "leave_saddle"])
def test_what_was_not_baked_is_refused(name):
    add_trefoil()
    before = contents()
    with pytest.raises(RuntimeError, match="has no keys of Möbius Flow; press Relax first"):
        getattr(OPS, f"mobius_flow_{name}")()
    assert contents() == before


@pytest.mark.parametrize("name", ["keep_size", "lay_flat", "face_camera", "balance", "check", "leave_saddle"])
def test_without_a_curve_the_buttons_say_so(name):
    show(bpy.data.objects.new("Empty", None))
    with pytest.raises(RuntimeError, match="is of type Empty; select a curve object"):
        getattr(OPS, f"mobius_flow_{name}")()
