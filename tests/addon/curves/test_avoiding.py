"""Objects that are avoided are never crossed: not between keys, in Blender's own numbers, nor by what goes on later."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, contents, in_world, relax, sentence, stored
from knot_diagrams import linking_number
from mathutils import Euler, Matrix, Vector
from mobius_flow import Relaxation
from mobius_flow.addon.curves.splines import key_points
from mobius_flow.addon.curves.surroundings import Surroundings
from mobius_flow.core import MobiusFlowError
from mobius_flow.core.collision import is_free
from mobius_flow.core.curve import Mesh
from shapes import hopf_link

TURNED = Matrix.LocRotScale(Vector((3, -1, 2)), Euler((0.3, 0.2, 0.7)), Vector((2, -0.5, 1)))
SHORT = {"max_iterations": 12, "vertices": 60}


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


def ring(n=24):
    """A stretched ring around the origin's circle, which would leave it if that were not there; (n, 3)."""
    return hopf_link(n).vertices[n:] * [1.0, 1.0, 4.0]


def circle(n=24):
    return hopf_link(n).vertices[:n]


def placed(obj, matrix):
    """Put an object elsewhere, with its points where they are in the world."""
    points = in_world(obj, stored(obj.data))
    obj.matrix_world = matrix
    bpy.context.view_layer.update()
    there = np.array(obj.matrix_world, dtype=np.float64)
    local = np.linalg.solve(there[:3, :3], (points - there[:3, 3]).T).T
    obj.data.splines[0].points.foreach_set("co", np.column_stack([local, np.ones(len(local))]).ravel())
    obj.data.update_tag()  # Blender 4.2 does not notice by itself
    return obj


def torus(radius=1.0, thickness=0.25):
    """A mesh torus around the circle, not selected."""
    selected = bpy.context.selected_objects
    bpy.ops.mesh.primitive_torus_add(major_radius=radius, minor_radius=thickness)
    obj = bpy.context.object
    obj.select_set(False)
    for each in selected:
        each.select_set(True)
        bpy.context.view_layer.objects.active = each
    return obj


def keys(obj):
    """The keyed points in the world, (n, 3) each."""
    return [in_world(obj, key_points(block)) for block in obj.data.shape_keys.key_blocks]


def free(obj, obstacles):
    """Whether all motions from key to key are, in doubles."""
    shapes = keys(obj)
    mesh = Mesh((len(shapes[0]),))
    return all(is_free(mesh, a, b, obstacles) for a, b in pairwise(shapes))


@pytest.mark.parametrize("matrix", [Matrix(), TURNED], ids=["plain", "turned"])
def test_a_curve_that_is_avoided_stays_linked(capfd, matrix):
    still, moving = add_curve([circle()], "A"), placed(add_curve([ring()], "B"), matrix)
    avoid(placed(still, TURNED.inverted()))
    circle_there = in_world(still, stored(still.data))
    before, wanted = stored(still.data), linking_number(circle(), ring())
    assert abs(wanted) == 1
    relax(vertices=60)
    assert "proved free of contact with itself, and with 'A'" in capfd.readouterr().out
    np.testing.assert_array_equal(stored(still.data), before)
    assert still.data.shape_keys is None
    assert np.abs(keys(moving)[-1] - keys(moving)[0]).max() > 0.5
    assert {linking_number(circle_there, key) for key in keys(moving)} == {wanted}
    assert free(moving, Surroundings.of([still], []).obstacles)


def test_scripts_give_objects_and_operators_the_name_of_a_collection():
    tube, by_script = torus(), add_curve([ring()], "Ring")
    by_script.select_set(False)
    report = Relaxation(by_script).relax(avoid=[tube, by_script], **SHORT)
    assert report.avoided == ("Torus",)
    by_name, collection = add_curve([ring()], "Again"), avoid(tube)
    bpy.context.scene.mobius_flow_surroundings.avoid = None
    relax(avoid=collection.name, **{"timing": "DISTANCE"} | SHORT)
    by_scene = add_curve([ring()], "Once More")
    by_name.select_set(False)
    bpy.context.scene.mobius_flow_surroundings.avoid = collection
    relax(**{"timing": "DISTANCE"} | SHORT)
    for other in (by_name, by_scene):
        np.testing.assert_array_equal(keys(other)[-1], keys(by_script)[-1])


def test_an_empty_name_avoids_nothing(capfd):
    avoid(torus())
    add_curve([ring()], "Ring")
    relax(avoid="", **SHORT)
    assert "proved free of contact with itself\n" in capfd.readouterr().out


@pytest.mark.parametrize("further", ["bake_again", "continue"])
def test_what_goes_on_avoids_it_too(capfd, further):
    tube, moving = torus(), add_curve([ring()], "Ring")
    avoid(tube)
    relax(**SHORT)
    bpy.context.scene.mobius_flow.max_iterations = 5
    assert getattr(bpy.ops.curve, f"mobius_flow_{further}")() == {"FINISHED"}
    assert capfd.readouterr().out.count("and with 'Torus'") == 2
    assert free(moving, Surroundings.of([tube], []).obstacles)


def test_images_of_equal_energy_are_not_taken():
    add_curve([ring()], "Ring")
    avoid(torus())
    said = "Balance does not go with what is avoided; leave it out, or avoid nothing"
    assert refused(balance=True) == said
    relax(**SHORT)
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.curve.mobius_flow_continue(balance=True)


def refused(**options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax(**SHORT | options)
    assert contents() == before
    return sentence(error.value)


def test_a_start_in_contact_is_refused_with_the_names_that_objects_have():
    tube = torus(thickness=1.2)
    tube.name = "edge of component 1"
    add_curve([ring()], "Ring")
    avoid(tube)
    assert (said := refused()).startswith("Segment 1 of spline 1 of 'Ring' pierces ")
    assert "'edge of component 1' at" in said


def test_there_is_no_such_collection():
    add_curve([ring()])
    assert refused(avoid="Walls") == "There is no collection 'Walls' to avoid"


def test_sizes_cannot_be_kept():
    add_curve([ring()], "Ring")
    avoid(torus())
    said = "Only the length can be kept where something is pinned or avoided; give keep_size='LENGTH', or none"
    assert refused(keep_size="BOX") == said


def test_a_curve_that_moves_avoids_nothing():
    moving = add_curve([ring()], "Ring")
    moving.keyframe_insert("location", frame=1)
    assert bpy.ops.curve.mobius_flow_relax.poll()
    avoid(torus())
    assert refused().startswith("'Ring' is moved by animation, and curves that avoid something must keep their places")


@pytest.mark.parametrize("wrong", [None, "Torus"])
def test_scripts_name_objects(wrong):
    add_curve([ring()], "Ring")
    with pytest.raises(MobiusFlowError, match="which is not an object"):
        Relaxation(bpy.data.objects["Ring"]).relax(avoid=[wrong])
    with pytest.raises(MobiusFlowError, match="avoid is of type NoneType; give a list of objects"):
        Relaxation(bpy.data.objects["Ring"]).relax(avoid=None)
