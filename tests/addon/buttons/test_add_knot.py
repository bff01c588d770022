"""Knots from the Add menu."""

import bpy
import numpy as np
import pytest
from blender_scenes import contents, sentence, stored
from mobius_flow.core import Curve
from mobius_flow.core.collision import check_embedded, gap
from mobius_flow.core.curve import distances
from mobius_flow.core.knots import knot, rounded


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({}, "thistlethwaite"),
        ({"knot": "4_1"}, "4_1"),
        ({"kind": "TORUS", "p": 2, "q": 5}, "T(2,5)"),
        ({"knot": "L2a1"}, "L2a1"),
    ],
)
def test_a_knot_is_added(options, name):
    bpy.context.scene.cursor.location = (3, 2, 1)
    assert bpy.ops.curve.mobius_flow_add_knot(**options, size=2.5) == {"FINISHED"}
    obj = bpy.context.object
    library = rounded(knot(name))  # its height does not change how it is cut into edges
    assert (obj.name, obj.type, obj.select_get()) == (name, "CURVE", True)
    assert tuple(obj.location) == (3, 2, 1)
    assert tuple(len(spline.points) for spline in obj.data.splines) == library.mesh.component_sizes
    assert all(spline.use_cyclic_u and spline.type == "POLY" for spline in obj.data.splines)
    points = stored(obj.data).astype(np.float64)
    assert np.ptp(points, axis=0).max() == pytest.approx(5)
    np.testing.assert_allclose(points.max(axis=0) + points.min(axis=0), 0, atol=1e-6)
    sizes = [len(spline.points) for spline in obj.data.splines]
    check_embedded(Curve.from_components(np.split(points, np.cumsum(sizes)[:-1])))


def test_a_torus_link_has_its_components():
    bpy.ops.curve.mobius_flow_add_knot(kind="TORUS", p=4, q=6)
    assert len(bpy.context.object.data.splines) == 2


def thickness(**options):
    """How thick the tube of an unknot is drawn."""
    bpy.ops.curve.mobius_flow_add_knot(**options)
    return bpy.context.object.data.bevel_depth


@pytest.mark.parametrize("given", [0.125, 0.0])
def test_a_given_thickness_is_taken(given):
    assert thickness(thickness=given) == thickness(fit_bevel=False, thickness=given) == given


def test_a_fitted_tube_has_the_thickness_it_needs():
    fitted = thickness()
    room = gap.thickness(Curve(stored(bpy.context.object.data).astype(np.float64)))
    assert 0.5 * room < fitted <= room
    assert thickness(fit_bevel=True, thickness=0.125) == fitted


def test_knots_are_added_beside_each_other_unless_a_place_is_given():
    for _ in range(3):
        bpy.ops.curve.mobius_flow_add_knot()
    first, *others = [obj.location.copy() for obj in sorted(bpy.data.objects, key=lambda obj: obj.location.x)]
    assert all(b.x - a.x > 2 for a, b in zip([first, *others], others, strict=False))
    bpy.ops.curve.mobius_flow_add_knot(location=first)
    assert bpy.context.object.location == first


def test_an_added_knot_can_be_relaxed():
    bpy.ops.curve.mobius_flow_add_knot()
    assert bpy.ops.curve.mobius_flow_relax(max_iterations=2) == {"FINISHED"}


@pytest.mark.parametrize(
    "options",
    [
        {"knot": "nonsense"},
        {"knot": ""},
        {"kind": "TORUS", "p": 0, "q": 3},
        {"kind": "TORUS", "p": 10**6, "q": 7},
        {"kind": "TORUS", "p": 3, "q": -101},
        {"knot": "m torus( 500, 501 )"},
        {"knot": "braid(" + ",".join(map(str, range(1, 300))) + ")"},
        {"size": float("nan")},
        {"size": float("inf")},
        {"thickness": float("nan")},
        {"thickness": float("inf")},
    ],
)
def test_what_is_no_knot_is_refused(options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_add_knot(**options)
    assert len(sentence(error.value)) > 10
    assert contents() == before


def test_a_misspelt_name_gets_no_advice_for_the_command_line():
    with pytest.raises(RuntimeError, match="did you mean trefoil") as error:
        bpy.ops.curve.mobius_flow_add_knot(knot="trefol")
    assert "--" not in sentence(error.value)
    assert "mobius-flow" not in sentence(error.value)


def test_not_in_edit_mode():
    bpy.ops.curve.mobius_flow_add_knot()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Object Mode"):
        bpy.ops.curve.mobius_flow_add_knot()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize(("p", "q"), [(60, 61), (61, 60), (3, 100)])
def test_strands_wound_tightly_do_not_take_all_pairs_of_points(monkeypatch, p, q):
    """All pairs within the thickest tube of T(60, 61) would be a hundred million."""
    looked_at = []
    counted = distances.arc_distance_of_vertices
    monkeypatch.setattr(
        distances, "arc_distance_of_vertices", lambda c, i, j: looked_at.append(len(i)) or counted(c, i, j)
    )
    bpy.ops.curve.mobius_flow_add_knot(kind="TORUS", p=p, q=q)
    obj = bpy.context.object
    assert obj.data.bevel_depth > 0
    assert 0 < sum(looked_at) < 40 * len(obj.data.splines[0].points)
