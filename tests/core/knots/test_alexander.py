"""The quick signature: right on the table, blind to position, and never wrong about equal types."""

import numpy as np
import pytest
from mobius_flow.core.knots import hard_unknot, knot, scramble, spiral, torus_knot
from mobius_flow.core.knots.alexander import _PRIME, signature
from shapes import hopf_link, regular_polygon

DETERMINANTS = {"0_1": 1, "3_1": 3, "4_1": 5, "5_1": 5, "5_2": 7, "6_1": 9, "6_2": 11, "6_3": 13, "7_7": 21, "8_19": 3}


@pytest.mark.parametrize("name", DETERMINANTS)
def test_determinants(name):
    value = signature(knot(name)).alexander[0][0]
    assert min(value, _PRIME - value) == DETERMINANTS[name]


def test_trefoil_at_a_root_of_unity():
    """Δ = t − 1 + t⁻¹ is −2 at a cube root of unity."""
    assert signature(knot("3_1")).alexander[0][1] == 2


def test_knots_of_the_same_determinant_differ():
    assert signature(knot("4_1")) != signature(knot("5_1"))
    assert signature(knot("3_1")) != signature(knot("8_19"))
    assert not signature(torus_knot(3, 5)).is_trivial  # determinant 1


def test_scrambles_and_turns_keep_it():
    curve = knot("6_2")
    expected = signature(curve)
    assert signature(scramble(curve, seed=5)) == expected
    q, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    q[:, 0] *= np.sign(np.linalg.det(q))
    assert signature(curve.with_vertices(curve.vertices @ q)) == expected


@pytest.mark.parametrize(
    "curve", [regular_polygon(50), spiral(5.0), hard_unknot(60, 7)], ids=["circle", "spiral", "60"]
)
def test_unknots(curve):
    assert signature(curve).is_trivial


def test_linking_numbers():
    assert [abs(x) for x in signature(hopf_link(20)).linking] == [1]
    assert signature(knot("L6a4")).linking == (0, 0, 0)
