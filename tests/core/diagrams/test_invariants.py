"""The quick signature: right on the table, blind to position, and never wrong about equal types."""

from fractions import Fraction

import numpy as np
import pytest
from hard_curves import hard_unknot, spiral
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.diagrams import quick_invariants
from mobius_flow.core.diagrams.invariants import FIELD
from mobius_flow.core.diagrams.polynomials import _matrices, alexander_values
from mobius_flow.core.knots import knot, scramble, torus_knot
from mobius_flow.core.knots.braids import braid_diagram
from shapes import hopf_link, regular_polygon

DETERMINANTS = {"0_1": 1, "3_1": 3, "4_1": 5, "5_1": 5, "5_2": 7, "6_1": 9, "6_2": 11, "6_3": 13, "7_7": 21, "8_19": 3}


@pytest.mark.parametrize("name", DETERMINANTS)
def test_determinants(name):
    value = quick_invariants(knot(name)).alexander[0][0]
    assert min(value, FIELD.prime - value) == DETERMINANTS[name]


def test_trefoil_at_a_root_of_unity():
    """Δ = t − 1 + t⁻¹ is −2 at a cube root of unity."""
    assert quick_invariants(knot("3_1")).alexander[0][1] == 2


def test_knots_of_the_same_determinant_differ():
    assert quick_invariants(knot("4_1")) != quick_invariants(knot("5_1"))
    assert quick_invariants(knot("3_1")) != quick_invariants(knot("8_19"))
    assert not quick_invariants(torus_knot(3, 5)).is_trivial  # determinant 1


def test_scrambles_and_turns_keep_it():
    curve = knot("6_2")
    expected = quick_invariants(curve)
    assert quick_invariants(scramble(curve, seed=5)) == expected
    q, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    q[:, 0] *= np.sign(np.linalg.det(q))
    assert quick_invariants(curve.with_vertices(curve.vertices @ q)) == expected


@pytest.mark.parametrize(
    "curve", [regular_polygon(50), spiral(5.0), hard_unknot(60, 7)], ids=["circle", "spiral", "60"]
)
def test_unknots(curve):
    assert quick_invariants(curve).is_trivial


def test_linking_numbers():
    assert [abs(x) for x in quick_invariants(hopf_link(20)).linking] == [1]
    assert quick_invariants(knot("L6a4")).linking == (0, 0, 0)


def test_strands_that_nearly_touch_are_told_apart():
    gap = 1e-12
    curve = Curve([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, gap], [0.0, 1.0, gap]])
    assert quick_invariants(curve).is_trivial


def test_curves_that_touch_themselves_have_none():
    once = knot("3_1").vertices
    with pytest.raises(CurveError, match="no view of the curve shows which one is in front"):
        quick_invariants(Curve(np.concatenate([once, once])))


@pytest.mark.parametrize("word", [(1, 1, 1), (1, -2) * 5, (1, 2, 3, -4) * 8 + (1, 2, 3)])
def test_determinants_by_elimination_are_those_of_fractions(word):
    """|Δ(−1)| by the shared elimination modulo the prime, against one in rational numbers."""
    diagram = braid_diagram(word)
    minus_one = np.array([FIELD.prime - 1])
    rows = [
        [Fraction((int(x) + 2) % FIELD.prime - 2) for x in row] for row in _matrices(diagram, minus_one, FIELD.prime)[0]
    ]
    value = int(alexander_values(diagram, minus_one, FIELD)[0])
    assert min(value, FIELD.prime - value) == abs(determinant(rows)) % FIELD.prime


def determinant(rows):
    """Of a square matrix of fractions."""
    if not rows:
        return Fraction(1)
    k = next((k for k, row in enumerate(rows) if row[0]), None)
    if k is None:
        return Fraction(0)
    pivot, *rest = [rows[k], *rows[:k], *rows[k + 1 :]]
    below = [[x - row[0] / pivot[0] * y for x, y in zip(row[1:], pivot[1:], strict=True)] for row in rest]
    return (-1) ** k * pivot[0] * determinant(below)
