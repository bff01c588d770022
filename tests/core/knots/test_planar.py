"""Polygons from planar diagram codes: the knot of the diagram, and coarse but not crumpled."""

import numpy as np
import pytest
from knot_diagrams import diagram
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core import Curve, CurveError, Status, minimize
from mobius_flow.core.collision import check_embedded, minimal_gap
from mobius_flow.core.knots import HARD_UNKNOTS, diagram_knot, knot
from mobius_flow.core.knots.alexander import signature

RIGHT_TREFOIL = [(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)]
LEFT_TREFOIL = [(1, 4, 2, 5), (3, 6, 4, 1), (5, 2, 6, 3)]
FIGURE_EIGHT = [(4, 2, 5, 1), (8, 6, 1, 5), (6, 3, 7, 4), (2, 7, 3, 8)]


@pytest.mark.parametrize(
    ("code", "name"),
    [(RIGHT_TREFOIL, "3_1"), (LEFT_TREFOIL, "m3_1"), (FIGURE_EIGHT, "4_1")],
    ids=["3_1", "m3_1", "4_1"],
)
def test_small_codes(code: list[tuple[int, int, int, int]], name: str) -> None:
    assert knot_invariants(diagram_knot(code).vertices) == knot_invariants(knot(name).vertices)


@pytest.mark.parametrize("name", ["5_2", "6_3", "7_7", "8_19", "9_42"])
def test_codes_read_off_other_polygons(name: str) -> None:
    curve = knot(name)
    code = diagram([curve.vertices]).pd_code()
    assert knot_invariants(diagram_knot(code).vertices) == knot_invariants(curve.vertices)


LONG = ("ochiai-4", "haken", "ochiai-2", "ochiai-3")


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.slow if each in LONG else ()) for each in HARD_UNKNOTS]
)
def test_hard_unknots(name: str) -> None:
    curve = knot(name)
    code = HARD_UNKNOTS[name]
    assert len(curve) == 4 * len(code)
    check_embedded(curve)
    assert minimal_gap(curve)[0] > 1e-4 * curve.edge_lengths.max()
    assert signature(curve).is_trivial
    assert knot_invariants(curve.vertices) == UNKNOT


def test_number_of_vertices() -> None:
    assert len(knot("Goeritz unknot", 100)) == 100
    assert np.array_equal(knot("ochiai 1").vertices, knot("Ochiai-1").vertices)
    for vertices, said in ((43, "too few"), (10**9, "too many")):
        with pytest.raises(CurveError, match=said):
            knot("goeritz", vertices)


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ([], "2 or more crossings"),
        ([(1, 4, 2, 5), (3, 6, 4, 1), (5, 2, 6, 7)], "every edge twice"),
        ([(1, 4, 2, 5), (3, 6, 4, 1), (2, 5, 6, 3)], "cannot be drawn in the plane"),
        ([*RIGHT_TREFOIL, *[tuple(10 + e for e in crossing) for crossing in RIGHT_TREFOIL]], "or falls apart"),
        ([(1, 8, 2, 1), (2, 6, 3, 5), (4, 3, 5, 4), (6, 8, 7, 7)], "cannot be drawn|undoes"),
    ],
)
def test_bad_codes_are_one_sentence(code: list[tuple[int, int, int, int]], said: str) -> None:
    with pytest.raises(CurveError, match=said):
        diagram_knot(code)


def test_links() -> None:
    code = [(6, 1, 7, 2), (8, 3, 5, 4), (2, 5, 3, 6), (4, 7, 1, 8)]
    curve = diagram_knot(code)
    assert curve.mesh.component_sizes == (8, 8)
    assert abs(signature(curve).linking[0]) == 2


@pytest.mark.parametrize(
    "name",
    ["culprit", "goeritz", *(pytest.param(name, marks=pytest.mark.slow) for name in ("thistlethwaite", "ochiai-1"))],
)
def test_they_relax_to_the_circle(name: str) -> None:
    result = minimize(knot(name))
    assert result.status is Status.CONVERGED
    assert result.energies[-1] < 4.01
    assert result.certified
    assert isinstance(result.curve, Curve)
