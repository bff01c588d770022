"""Several selected curve objects are one link: relaxed together in world space, each keyed in its own coordinates."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, contents, evaluated, fcurves, in_world, relax, sentence, show, stored
from families import crossed
from knot_diagrams import linking_number
from mathutils import Euler, Matrix, Vector
from mobius_flow.addon.curves import keyframes
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve import Mesh
from shapes import hopf_link

TURNED = Matrix.LocRotScale(Vector((3, -1, 2)), Euler((0.3, 0.2, 0.7)), Vector((2, -0.5, 1)))
SHORT = {"max_iterations": 12, "vertices": 80}


def ring(points, name, matrix=None):
    """A curve object with these points in the world, wherever it is itself."""
    obj = add_curve([points], name)
    if matrix is not None:
        obj.matrix_world = matrix
        bpy.context.view_layer.update()
        placed = np.array(obj.matrix_world, dtype=np.float64)
        local = np.linalg.solve(placed[:3, :3], (points - placed[:3, 3]).T).T
        obj.data.splines[0].points.foreach_set("co", np.column_stack([local, np.ones(len(local))]).ravel())
    return obj


def tangled(n=24):
    """Two linked rings, the second stretched so that it would leave the first if that were not there."""
    vertices = hopf_link(n).vertices.copy()
    vertices[n:] *= [1.0, 1.0, 2.5]
    return vertices[:n], vertices[n:]


def rings(matrix=TURNED):
    first, second = tangled()
    return ring(first, "A"), ring(second, "B", matrix)


def world_keys(objects):
    """World positions of the keyed points, (keys, n, 3), with the objects' vertices one after the other."""
    each = []
    for obj in objects:
        blocks = obj.data.shape_keys.key_blocks
        keys = np.empty((len(blocks), 3 * len(blocks[0].data)), dtype=np.float32)
        for k, block in enumerate(blocks):
            block.data.foreach_get("co", keys[k])
        each.append([in_world(obj, key.reshape(-1, 3)) for key in keys])
    return np.concatenate(each, axis=1)


def test_linked_rings_stay_linked_and_are_proved_together(capfd):
    objects = rings()
    placed = [obj.matrix_world.copy() for obj in objects]
    wanted = linking_number(*tangled())
    assert abs(wanted) == 1
    relax(vertices=80)
    assert "'A' and 'B' converged" in (said := capfd.readouterr().out)
    assert "proved free of contact with themselves and each other" in said
    assert [obj.matrix_world for obj in objects] == placed
    times = [[point.co[0] for point in fcurves(obj.data.shape_keys)[0].keyframe_points] for obj in objects]
    assert times[0] == times[1]
    sizes = tuple(len(stored(obj.data)) for obj in objects)
    keys = world_keys(objects)
    assert len(keys) > 5
    assert np.abs(keys[-1] - keys[0]).max() > 0.5
    for key in keys:
        assert linking_number(*np.split(key, [sizes[0]])) == wanted
    for a, b in pairwise(keys):
        assert is_free(Mesh(sizes), a, b)


@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "FCURVES", "RESULT"])
def test_objects_move_as_splines_of_one_object_would(keyframes):
    together = add_curve(tangled())
    relax(keyframes=keyframes, **SHORT)
    bpy.ops.object.select_all(action="DESELECT")
    objects = rings(matrix=None)
    relax(keyframes=keyframes, **SHORT)
    for frame in (1, 4, 7.5, 13):
        apart = np.concatenate([evaluated(obj, frame) for obj in objects])
        np.testing.assert_array_equal(apart, evaluated(together, frame))
    assert all(np.ptp(evaluated(obj, 13), axis=0).max() > 0 for obj in objects)


@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "FCURVES", "RESULT"])
def test_any_transforms(keyframes):
    expected = add_curve(tangled())
    relax(keyframes="RESULT", **SHORT)
    bpy.ops.object.select_all(action="DESELECT")
    objects = rings()
    relax(keyframes=keyframes, **SHORT)
    shown = np.concatenate([in_world(obj, evaluated(obj, 13)) for obj in objects])
    np.testing.assert_allclose(shown, stored(expected.data), atol=2e-5)


@pytest.mark.parametrize("active", [0, 1])
def test_which_object_is_active_does_not_matter(active):
    before = rings()
    relax(keyframes="RESULT", keep_size="AUTO", **SHORT)
    expected = [stored(obj.data) for obj in before]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    objects = rings()
    bpy.context.view_layer.objects.active = objects[active]
    relax(keyframes="RESULT", **SHORT)
    for a, obj in zip(expected, objects, strict=True):
        np.testing.assert_array_equal(stored(obj.data), a)


def test_fitted_tubes_of_different_objects_do_not_touch():
    first, second = tangled()
    objects = ring(first, "A"), ring(second, "B", Matrix.Diagonal((3, 3, 3, 1)))
    for obj in objects:
        for point in obj.data.splines[0].points:
            point.radius = 1.0
    relax(fit_bevel=True, keyframes="RESULT", vertices=200)
    a, b = (in_world(obj, stored(obj.data)) for obj in objects)
    gap = np.linalg.norm(a[:, None] - b[None], axis=2).min()
    depths = [obj.data.bevel_depth for obj in objects]
    assert depths[0] == pytest.approx(3 * depths[1])
    assert 0 < 2 * depths[0] < gap


def test_modifiers_are_not_part_of_the_proof(capfd):
    objects = rings()
    objects[1].modifiers.new("Array", "ARRAY")
    relax(keyframes="RESULT", **SHORT)
    assert "proved free of contact with themselves and each other, before modifiers" in capfd.readouterr().out


def test_what_is_selected_besides_curves_is_not_relaxed():
    obj, _ = rings()
    show(bpy.data.objects.new("Mesh", bpy.data.meshes.new("Mesh")))
    assert bpy.ops.curve.mobius_flow_relax(**SHORT) == {"FINISHED"}
    assert obj.data.shape_keys is not None


def refused():
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax(**SHORT)
    assert contents() == before
    return sentence(error.value)


def test_every_selected_object_is_looked_at():
    rings()[0].data.dimensions = "2D"
    assert "'A' is a 2D curve" in refused()


def test_objects_that_touch_each_other_are_refused():
    vertices = hopf_link(24).vertices
    ring(vertices[:24].astype(np.float32), "A")
    ring(vertices[:24].astype(np.float32), "B", Matrix.Diagonal((2, 2, 2, 1)))
    assert "touch" in refused()


def keyed(obj):
    obj.keyframe_insert("location", frame=1)
    return "animation"


def driven(obj):
    obj.driver_add("rotation_euler", 0)
    return "a driver"


def constrained(obj):
    obj.constraints.new("COPY_LOCATION")
    return "a constraint"


def tracked(obj):
    obj.animation_data_create().nla_tracks.new()
    return "an NLA track"


def carried(obj):
    parent = show(bpy.data.objects.new("Parent", None))
    parent.keyframe_insert("scale", frame=1)
    obj.parent = parent
    parent.select_set(False)
    return "animation of its parent"


def vertex_parented(obj):
    data = bpy.data.meshes.new("Parent")
    data.from_pydata([(0, 0, 0)], [], [])
    obj.parent = show(bpy.data.objects.new("Parent", data))
    obj.parent_type = "VERTEX"
    return "its parent"


def on_a_path(obj):
    obj.parent = add_curve([hopf_link(24).vertices[:24] + 9], "Path")
    obj.parent.data.use_path = True
    obj.parent.select_set(False)
    return "its parent"


MOVES = [keyed, driven, constrained, tracked, carried, vertex_parented, on_a_path]


@pytest.mark.parametrize("move", MOVES)
def test_places_of_several_must_stay(move):
    _, second = rings()
    mover = move(second)
    bpy.context.view_layer.update()
    said = refused()
    assert said.startswith(f"'B' is moved by {mover}, and curves relaxed together must keep their places")


@pytest.mark.parametrize("move", MOVES)
def test_a_single_curve_may_be_moved(move):
    first, second = rings()
    move(second)
    first.select_set(False)
    bpy.context.view_layer.update()
    assert bpy.ops.curve.mobius_flow_relax(**SHORT) == {"FINISHED"}


def test_other_animation_of_several_stays():
    _, second = rings()
    second.keyframe_insert("color", frame=1)
    second.keyframe_insert("hide_render", frame=1)
    relax(**SHORT)
    assert {curve.data_path for curve in fcurves(second)} == {"color", "hide_render"}


@pytest.mark.parametrize(("output", "kind"), crossed(["SHAPE_KEYS", "FCURVES", "RESULT"], ["POLY", "BEZIER", "NURBS"]))
def test_whatever_fails_while_writing_all_is_put_back(monkeypatch, output, kind):
    for k, points in enumerate(tangled(12)):
        add_curve([2 * points], f"Ring {k}", kind=kind)
    before = contents()
    pieces = keyframes.writing

    def failing(*arguments):
        for k, piece in enumerate(pieces(*arguments)):
            if k == 2 or arguments[0].name == "Ring 1":
                raise MemoryError("no room")
            yield piece
        raise MemoryError("no room")

    monkeypatch.setattr(keyframes, "writing", failing)
    with pytest.raises(RuntimeError, match="Memory ran out; all is as it was"):
        bpy.ops.curve.mobius_flow_relax(max_iterations=3, keyframes=output, sample_splines=True)
    assert contents() == before
