"""Selected curves are one link, relaxed in the world past what they avoid: proved together, in Blender's numbers."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, contents, evaluated, in_world, relax, sentence, show, stored
from knot_diagrams import linking_number
from mathutils import Euler, Matrix, Vector
from mobius_flow import Relaxation
from mobius_flow.addon.curves import keyframes
from mobius_flow.addon.curves.surroundings import Surroundings
from mobius_flow.core import MobiusFlowError
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve import Mesh
from shapes import hopf_link

TURNED = Matrix.LocRotScale(Vector((3, -1, 2)), Euler((0.3, 0.2, 0.7)), Vector((2, -0.5, 1)))
SHORT = {"max_iterations": 12, "vertices": 80, "radius": "none"}


def tangled(n=24):
    """Two linked rings, the second stretched so that it would leave the first if that were not there."""
    vertices = hopf_link(n).vertices.copy()
    vertices[n:] *= [1.0, 1.0, 4.0]
    return vertices[:n], vertices[n:]


def ring(points, name, matrix=None):
    """A curve object with these points in the world, wherever it is itself."""
    obj = add_curve([points], name)
    if matrix is not None:
        obj.matrix_world = matrix
        bpy.context.view_layer.update()
        there = np.array(obj.matrix_world, dtype=np.float64)
        local = np.linalg.solve(there[:3, :3], (points - there[:3, 3]).T).T
        obj.data.splines[0].points.foreach_set("co", np.column_stack([local, np.ones(len(local))]).ravel())
        obj.data.update_tag()  # Blender 4.2 does not notice by itself
    return obj


def rings(matrix=TURNED):
    first, second = tangled()
    return ring(first, "A"), ring(second, "B", matrix)


def world_keys(objects):
    """World positions of the keyed points, (keys, n, 3), with the objects' vertices one after the other."""
    each = [[in_world(obj, points) for points in keyframes.keyed_points(obj.data)] for obj in objects]
    return np.concatenate(each, axis=1)


def avoid(*objects, name="Avoid"):
    """A collection of these objects that the scene's curves avoid; none of them is selected."""
    collection = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(collection)
    for obj in objects:
        collection.objects.link(obj)
        obj.select_set(False)
    bpy.context.scene.mobius_flow_surroundings.avoid = collection
    bpy.context.view_layer.update()
    return collection


def torus(thickness=0.25):
    """A mesh torus around the first ring, which is not selected."""
    bpy.ops.mesh.primitive_torus_add(major_radius=1.0, minor_radius=thickness)
    obj = bpy.context.object
    obj.select_set(False)
    return obj


def refused(**options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax(**SHORT | options)
    assert contents() == before
    return sentence(error.value)


# -- together --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "RESULT"])
def test_objects_move_as_splines_of_one_object_would_wherever_they_are(keyframes):
    together = add_curve(tangled())
    relax(keyframes=keyframes, **SHORT)
    for matrix, tolerance in ((None, 0.0), (TURNED, 2e-5)):
        bpy.ops.object.select_all(action="DESELECT")
        objects = rings(matrix)
        bpy.context.view_layer.objects.active = objects[matrix is None]  # which one it is does not matter
        relax(keyframes=keyframes, **SHORT)
        for frame in (1, 4, 7.5, 13):
            apart = np.concatenate([in_world(obj, evaluated(obj, frame)) for obj in objects])
            np.testing.assert_allclose(apart, evaluated(together, frame), rtol=0, atol=tolerance)
        assert all(np.ptp(evaluated(obj, 13), axis=0).max() > 0 for obj in objects)


def driven(obj):
    obj.driver_add("rotation_euler", 0)


def tracked(obj):
    obj.animation_data_create().nla_tracks.new()


def carried(obj):
    obj.parent = show(bpy.data.objects.new("Parent", None))
    obj.parent.keyframe_insert("scale", frame=1)
    obj.parent.select_set(False)


def vertex_parented(obj):
    data = bpy.data.meshes.new("Parent")
    data.from_pydata([(0, 0, 0)], [], [])
    obj.parent = show(bpy.data.objects.new("Parent", data))
    obj.parent_type = "VERTEX"


def on_a_path(obj):
    obj.parent = add_curve([hopf_link(24).vertices[:24] + 9], "Path")
    obj.parent.data.use_path = True
    obj.parent.select_set(False)


MOVES = [
    (lambda obj: obj.keyframe_insert("location", frame=1), "animation"),
    (driven, "a driver"),
    (lambda obj: obj.constraints.new("COPY_LOCATION"), "a constraint"),
    (tracked, "an NLA track"),
    (carried, "animation of its parent"),
    (vertex_parented, "its parent"),
    (on_a_path, "its parent"),
]


@pytest.mark.parametrize(("move", "mover"), MOVES)
def test_only_a_single_curve_may_be_moved(move, mover):
    first, second = rings()
    move(second)
    bpy.context.view_layer.update()
    assert refused().startswith(f"'B' is moved by {mover}, and curves relaxed together must keep their places")
    first.select_set(False)
    assert bpy.ops.curve.mobius_flow_relax(**SHORT) == {"FINISHED"}


# -- past what they avoid --------------------------------------------------------------------------------------------


def free(obj, obstacles):
    """Whether all motions from key to key are, in doubles."""
    shapes = world_keys([obj])
    return all(is_free(Mesh((len(shapes[0]),)), a, b, obstacles) for a, b in pairwise(shapes))


@pytest.mark.parametrize("matrix", [None, TURNED], ids=["plain", "turned"])
def test_a_curve_that_is_avoided_stays_linked(capfd, matrix):
    circle, stretched = tangled()
    still, moving = ring(circle, "A", TURNED.inverted()), ring(stretched, "B", matrix)
    avoid(still)
    before, there = stored(still.data), in_world(still, stored(still.data))
    relax(vertices=60)
    assert "proved free of contact with itself, and with 'A'" in capfd.readouterr().out
    np.testing.assert_array_equal(stored(still.data), before)
    assert still.data.shape_keys is None
    shapes = world_keys([moving])
    assert np.abs(shapes[-1] - shapes[0]).max() > 0.5
    assert {linking_number(there, shape) for shape in shapes} == {linking_number(circle, stretched)}
    assert free(moving, Surroundings([still], []).obstacles)


def test_scripts_give_objects_and_operators_the_name_of_a_collection(capfd):
    tube, options = torus(), {"timing": "DISTANCE"} | SHORT
    collection = avoid(tube)
    shapes = {}
    for way in ("script", "name", "scene", "nothing"):
        bpy.ops.object.select_all(action="DESELECT")
        obj = add_curve([tangled()[1]], way)
        bpy.context.scene.mobius_flow_surroundings.avoid = None if way == "name" else collection
        if way == "script":
            assert Relaxation(obj).relax(avoid=[tube, obj], **SHORT).avoided == ("Torus",)
        else:
            relax(**options | {"name": {"avoid": collection.name}, "nothing": {"avoid": ""}}.get(way, {}))
            alone = "proved free of contact with itself\n" in capfd.readouterr().out
            assert alone == (way == "nothing")
        shapes[way] = world_keys([obj])[-1]
    np.testing.assert_array_equal(shapes["name"], shapes["script"])
    np.testing.assert_array_equal(shapes["scene"], shapes["script"])


def test_what_does_not_go_with_obstacles_is_refused():
    tube, moving = torus(), add_curve([tangled()[1]], "Ring")
    assert refused(avoid="Walls") == "There is no collection 'Walls' to avoid"
    avoid(tube)
    balance = "Balance does not go with what is avoided; leave it out, or avoid nothing"
    assert refused(balance=True) == balance
    said = "Only the length can be kept where something is pinned or avoided; give keep_size='LENGTH', or none"
    assert refused(keep_size="BOX") == said
    for wrong in (None, "Torus"):
        with pytest.raises(MobiusFlowError, match="which is not an object"):
            Relaxation(moving).relax(avoid=[wrong])
    with pytest.raises(MobiusFlowError, match="avoid is of type NoneType; give a list of objects"):
        Relaxation(moving).relax(avoid=None)
    relax(**SHORT)
    with pytest.raises(RuntimeError, match=balance):
        bpy.ops.curve.mobius_flow_continue(balance=True)
