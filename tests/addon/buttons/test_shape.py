"""Buttons of the panel Shape: sizes that are kept, curves that are turned, colours, constant tubes."""

from itertools import pairwise

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
from mobius_flow.addon.buttons import shape
from mobius_flow.addon.curves import recorded
from mobius_flow.addon.curves.recorded import BakedKeys, Recorded
from mobius_flow.core import Curve
from mobius_flow.core.collision import is_free
from mobius_flow.core.keys.colours import PALETTE
from mobius_flow.core.keys.placement import Measure
from shapes import hopf_link, lattice_knot, torus_trefoil

OPS = bpy.ops.curve
FLAT = torus_trefoil(40).vertices[:, [2, 0, 1]]  # which lies on its side
MEASURES = [measure.name for measure in Measure]


def baked(**options):
    """A lattice figure-eight knot that shrinks as seen on the screen."""
    add_curve([lattice_knot("4_1").vertices])
    return relax(**{"max_iterations": 8, "vertices": 120} | options)


def of_keys(objects, measure):
    return [Measure[measure].of(curve) for curve in BakedKeys(objects).curves]


@pytest.mark.parametrize("measure", MEASURES)
def test_a_size_stays(measure):
    obj = baked()
    place(obj)
    frames = np.linspace(*obj.data.shape_keys.animation_data.action.curve_frame_range, 5)
    before = [Curve(in_world(obj, evaluated(obj, frame))) for frame in frames]
    assert OPS.mobius_flow_keep_size(measure=measure) == {"FINISHED"}
    after, measured = [Curve(in_world(obj, evaluated(obj, frame))) for frame in frames], Measure[measure].of
    np.testing.assert_allclose(after[0].vertices, before[0].vertices, atol=1e-5)
    np.testing.assert_allclose(of_keys([obj], measure), measured(before[0]), rtol=1e-5)
    for a, b in zip(before, after, strict=True):
        centers = [curve.edge_lengths @ curve.midpoints / curve.length for curve in (a, b)]
        assert np.linalg.norm(centers[1] - centers[0]) < 0.05 * measured(before[0])
    keys = BakedKeys([obj])  # proved as they are stored
    assert keys.unproved == 0
    for a, b in pairwise(keys.frames):
        assert is_free(keys.mesh, a.astype(float), b.astype(float))


def test_motions_that_cannot_be_proved_are_told_of(monkeypatch):
    obj, told = baked(), []
    monkeypatch.setattr(recorded, "is_free", lambda *_: False)
    monkeypatch.setattr(shape, "_report", lambda _, what, unproved: told.append((what, unproved)))
    assert OPS.mobius_flow_keep_size(measure="BOX") == {"FINISHED"}
    count = len(obj.data.shape_keys.key_blocks)
    assert told == [(f"The bounding box of 'Knot' stays at all {count} keys", count - 1)]
    monkeypatch.undo()

    class Teller:
        def report(self, *words):
            told.append(words)

    for unproved in range(3):
        shape._report(Teller(), "It stays", unproved)
    assert told[1:] == [
        ({"INFO"}, "It stays, proved free of contact"),
        ({"WARNING"}, "It stays; 1 motion between keys is NOT proved free of contact"),
        ({"WARNING"}, "It stays; 2 motions between keys are NOT proved free of contact"),
    ]


def test_the_tube_is_scaled_with_the_curve():
    obj = baked(fit_bevel=True)
    radii, lengths = Recorded.of(obj).radii[:, 0], [curve.length for curve in BakedKeys([obj]).curves]
    OPS.mobius_flow_keep_size(measure="BOX")
    factors = [curve.length / old for curve, old in zip(BakedKeys([obj]).curves, lengths, strict=True)]
    assert max(factors) > 1.05 * min(factors)
    np.testing.assert_allclose(Recorded.of(obj).radii[:, 0], np.multiply(radii, factors), rtol=1e-4)


@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "RESULT"])
@pytest.mark.parametrize("measure", ["BOX", "RADIUS"])
def test_a_size_stays_while_it_is_baked_and_further(keyframes, measure):
    size = Measure[measure].of(Curve(lattice_knot("4_1").vertices))
    obj = baked(keyframes=keyframes, keep_size=measure)
    if keyframes == "RESULT":
        assert Measure[measure].of(Curve(stored(obj.data).astype(float))) == pytest.approx(size, rel=1e-5)
        return
    for _ in range(2):
        np.testing.assert_allclose(of_keys([obj], measure), size, rtol=1e-5)
        assert BakedKeys([obj]).unproved == 0
        OPS.mobius_flow_continue(max_iterations=5, keep_size=measure, fit_bevel=False)


@pytest.mark.parametrize("is_baked", [False, True])
def test_flat_curves_extend_least_upwards(is_baked):
    obj = add_curve([FLAT])
    if is_baked:
        relax(max_iterations=5)
    place(obj)
    scale, points = obj.scale.copy(), stored(obj.data)
    assert OPS.mobius_flow_lay_flat() == {"FINISHED"}
    x, y, z = np.ptp(in_world(obj, evaluated(obj)), axis=0)
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


def uneven_parent(obj):
    """An empty whose scale shears what is turned under it."""
    parent = show(bpy.data.objects.new("Parent", None))
    parent.rotation_euler, parent.scale = (0.3, 0.5, 1.0), (2.0, 0.5, -1.0)
    obj.parent, obj.rotation_euler = parent, (0.4, 0.0, 0.2)
    parent.select_set(False)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return parent


HELD = {
    keyed_rotation: "'Knot' is moved by animation",
    uneven_parent: "'Knot' would change its shape, as its parent's scale is uneven",
}


@pytest.mark.parametrize("hold", HELD)
def test_what_cannot_be_turned_is_refused(hold):
    hold(add_trefoil())
    before = contents()
    with pytest.raises(RuntimeError) as error:
        OPS.mobius_flow_lay_flat()
    assert sentence(error.value) == f"{HELD[hold]}; remove that first"
    assert contents() == before


def test_a_single_point_has_no_flat_side():
    add_curve([np.zeros((3, 3))])
    with pytest.raises(RuntimeError, match="All points of the curves are the same; move them apart"):
        OPS.mobius_flow_lay_flat()


def test_links_are_turned_as_one():
    objects = [add_curve([part], name) for part, name in zip(hopf_link(24).components, "AB", strict=True)]
    objects[1].parent = objects[0]
    objects[0].location, objects[0].rotation_euler = (1, 2, 3), (0.5, 0.6, 0.7)
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


def colours(obj):
    """The colour of each spline."""
    materials = [obj.data.materials[spline.material_index] for spline in obj.data.splines]
    shaders = [next(n for n in each.node_tree.nodes if n.type == "BSDF_PRINCIPLED") for each in materials]
    return [tuple(shader.inputs["Base Color"].default_value)[:3] for shader in shaders]


def test_components_are_coloured_through_all_objects_and_in_turn():
    one, other = add_hopf_link(), add_hopf_link()
    one.data.materials.append(bpy.data.materials.new("Mine"))
    for _ in range(2):
        assert OPS.mobius_flow_color_components() == {"FINISHED"}
        assert one.data.materials[0].name == "Mine", "one's own slots stay"
        assert len(one.data.materials) == 3
        assert colours(one) + colours(other) == [pytest.approx(colour) for colour in PALETTE[:4]]
    bpy.ops.object.select_all(action="DESELECT")
    many = add_curve([hopf_link(12).components[0] + np.array([0, 0, 3 * k]) for k in range(7)])
    OPS.mobius_flow_color_components()
    assert len(many.data.materials) == len(PALETTE)
    assert colours(many)[5:] == colours(many)[:2]
