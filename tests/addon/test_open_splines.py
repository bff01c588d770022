"""Splines that are not cyclic are relaxed as open components, and stay open whatever becomes of them."""

import bpy
import numpy as np
import pytest
from baked_curves import SHORT
from blender_scenes import add_curve, evaluated, relax, stored
from mobius_flow.addon.live.requirements import RELAXABLE
from mobius_flow.core import Curve, Mesh, RelaxOptions, minimize
from mobius_flow.core.knots import overhand
from shapes import regular_polygon

ARC = overhand(60).vertices
RING = regular_polygon(30).vertices + np.array([0.0, 0.0, 20.0])


def add_arc(**options):
    return add_curve([ARC], cyclic=False, **options)


def add_both():
    """A closed spline and an open one in one object."""
    obj = add_curve([RING, ARC])
    obj.data.splines[1].use_cyclic_u = False
    return obj


def cyclic(obj):
    return [spline.use_cyclic_u for spline in obj.data.splines]


@pytest.mark.usefixtures("defaults")
def test_the_result_is_the_librarys_and_a_spline_that_is_closed_later_is_another():
    obj = add_arc()
    start = Curve(stored(obj.data).astype(np.float64), Mesh((60,), (False,)))
    result = minimize(start, RelaxOptions(max_iterations=5)).curve
    relax(max_iterations=5)
    np.testing.assert_array_equal(stored(obj.data), result.vertices.astype(np.float32))
    assert cyclic(obj) == [False]
    obj.data.splines[0].use_cyclic_u = True
    bpy.context.view_layer.update()
    assert "has other keys or points than it was baked with" in RELAXABLE(bpy.context).sentence


def test_a_segment_is_a_curve():
    obj = add_curve([np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])], cyclic=False)
    relax(max_iterations=3, keyframes="RESULT")
    points = stored(obj.data).astype(np.float64)
    np.testing.assert_allclose(points[[0, -1]], [[0, 0, 0], [1, 2, 3]], atol=1e-6)


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_a_smooth_open_spline_becomes_a_polygon_from_end_to_end(kind):
    obj = add_arc(kind=kind)
    obj.data.splines[0].use_endpoint_u = True
    assert bpy.ops.curve.mobius_flow_mend(remedy="TO_POLY") == {"FINISHED"}
    np.testing.assert_allclose(stored(obj.data)[[0, -1]], ARC[[0, -1]], atol=1e-5)  # Blender 4.2 is not that exact
    assert cyclic(obj) == [False]


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_its_smooth_curve_runs_from_end_to_end(kind, capfd):
    add_both()
    obj = relax(**SHORT)
    end = obj.data.shape_keys.key_blocks[-1].data[-1].co.copy()
    assert bpy.ops.curve.mobius_flow_smooth_curve(kind=kind) == {"FINISHED"}
    assert "the same knot, proved" in capfd.readouterr().out
    made = bpy.context.object
    assert cyclic(made) == [True, False]
    np.testing.assert_allclose(evaluated(made)[-1], end, atol=1e-5)
