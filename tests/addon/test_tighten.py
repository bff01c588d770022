"""Tighten: selected knots are pulled tight, keyed and proved as a relaxation is."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve
from mobius_flow import Relaxation
from mobius_flow.addon.curves import bake
from mobius_flow.addon.live.modal import status_line
from mobius_flow.addon.scripting import begin, complete
from mobius_flow.core.collision import thickness
from mobius_flow.core.knots import knot


def trefoil():
    obj = add_curve([knot("3_1", 60).vertices], "Knot")
    obj.select_set(True)
    return obj


def test_a_button_pulls_a_trefoil_tight_and_clear_undoes_it():
    obj = trefoil()
    before = Relaxation(obj)
    assert bpy.ops.curve.mobius_flow_tighten(vertices=100, time_limit=60) == {"FINISHED"}
    first, last = (before.curves[k] for k in (0, -1))
    assert last.length / thickness(last) < 32.9
    assert last.length < 0.7 * first.length
    assert thickness(last) == pytest.approx(0.9 * thickness(first), rel=1e-5)
    check_contacts(obj, last)
    assert bpy.ops.curve.mobius_flow_continue(max_iterations=1) == {"FINISHED"}
    assert len(bake.contacts(obj.data)[0]) == 0, "points have moved since"
    before.clear()
    assert len(bake.contacts(obj.data)[0]) == 0


def test_a_bevel_is_the_rope():
    obj = trefoil()
    obj.data.bevel_depth = 0.1
    session = begin([obj], complete({"vertices": 100}) | {"avoid": ()}, starts=1)
    assert session.job.radius == pytest.approx(0.1)
    Relaxation(obj).tighten(vertices=100)
    assert thickness(Relaxation(obj).curves[-1]) == pytest.approx(0.1, rel=1e-4)


def test_a_live_run_shows_the_length(operator):
    trefoil()
    operator.more = lambda _context: {"starts": 1}
    operator.given["vertices"] = 100
    operator.start()
    operator.reach(1)
    assert status_line(operator.run).startswith("'Knot': step 1 (Length in Radii ")
    assert "Drag" not in status_line(operator.run)
    operator.until(lambda: operator.run.state.over)
    assert not operator.run.time_left.distances
    assert operator.run.energies[-1] < 33.0


def check_contacts(obj, curve):
    """Tube Mesh has the forces of the struts beside it, whose lengths are two radii."""
    obj.rotation_euler.x, obj.location.z = 1.0, 3.0
    bpy.ops.curve.mobius_flow_tube_mesh(sides=3)
    struts = bpy.data.objects["Knot Struts"]
    ends = np.array([point.co for point in struts.data.vertices]).reshape(-1, 2, 3)
    assert len(ends) > 50
    np.testing.assert_allclose(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), 2 * thickness(curve), rtol=0.1)
    assert np.linalg.norm(curve.vertices - ends[0, 0], axis=1).min() < 0.5 * curve.edge_lengths.max()
    np.testing.assert_array_equal(struts.matrix_world, bpy.data.objects["Knot Tube"].matrix_world)
    pressing = np.array([each.value for each in bpy.context.object.data.attributes["contact_force"].data])[::3]
    forces = sum(each.value for each in struts.data.attributes["force"].data)
    at_vertices = 0.5 * (curve.edge_lengths + curve.edge_lengths[curve.mesh.previous])
    assert pressing @ at_vertices == pytest.approx(2 * forces * thickness(curve), rel=1e-3)
    rings = np.array([vertex.co for vertex in bpy.context.object.data.vertices]).reshape(-1, 3, 3)
    radii = np.linalg.norm(rings - rings.mean(axis=1, keepdims=True), axis=2)
    assert radii.min() == pytest.approx(thickness(curve), rel=1e-2), "it is the rope, without a bevel"
    for each in (struts, bpy.context.object):
        bpy.data.objects.remove(each)
    obj.hide_set(False)
    obj.select_set(True)
