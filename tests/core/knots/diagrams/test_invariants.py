"""Invariants of diagrams against independent computations, and against tables."""

import numpy as np
import pytest
from braid_words import burau_alexander
from families import family
from hard_curves import hard_unknot, spiral
from jones import jones as slow_jones
from known_knots import KNOWN
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.knots import KNOTS, braid_word, knot, scramble, torus_knot
from mobius_flow.core.knots.braids import braid_diagram
from mobius_flow.core.knots.diagrams import (
    Diagram,
    alexander,
    doubled_bracket,
    jones,
    quick_invariants,
    signature,
    simplified,
    views,
)
from mobius_flow.core.knots.diagrams.invariants import MAX_CROSSINGS, alexander_value
from shapes import hopf_link, regular_polygon
from spherogram import Link

CIRCLE, PRIME = Diagram(((),), ()), 2_147_389_441
# Signatures that are not −2τ, from KnotInfo, for the handedness of the table.
SIGNATURES = {"9_42": 2, "10_132": 0, "10_136": 2, "10_139": -6, "10_145": 2, "10_152": -6, "10_154": -4, "10_161": -4}


@pytest.mark.parametrize("name", family(KNOWN))
def test_invariants_of_the_table(name):
    diagram = braid_diagram(KNOTS[name])
    assert alexander(diagram) == KNOWN[name].alexander
    assert jones(diagram) == KNOWN[name].jones
    assert signature(diagram) == SIGNATURES.get(name, -2 * KNOWN[name].tau)


@pytest.mark.parametrize("name", ["L2a1", "L5a1", "L6a4", "L7n2", "3_1#m4_1", "T(3,4)", "braid(1,1,3,3)", "braid(1,3)"])
def test_links_have_the_jones_polynomial_of_slow_sums(name):
    diagram = braid_diagram(braid_word(name))
    link = Link(diagram.planar_code)
    link.unlinked_unknot_components += sum(not part for part in diagram.passes)
    assert jones(diagram) == slow_jones(link)


WORDS = [(1, 2, 1, -3, 2, 2, 1), (1, 1, 2, -1, 3, 2, -3, 1, 2, 2, -1), (1, 1, 1), (1, -2) * 5, (1, 2, 3, -4) * 9]
LONG = [(1, -2) * 25, (1, -2, 3) * 19, (1,) * 59]  # with coefficients above half a prime


@pytest.mark.parametrize("word", [*WORDS, *LONG])
def test_alexander_polynomials_of_any_word(word):
    """Against another matrix; |Δ(−1)| also by elimination modulo a prime."""
    diagram, expected = braid_diagram(word), burau_alexander(word, max(map(abs, word)) + 1)
    assert len(diagram.passes) == 1
    assert alexander(diagram) == expected
    determinant = abs(sum((-1) ** k * c for k, c in enumerate(expected))) % PRIME
    assert alexander_value(diagram, PRIME - 1, PRIME) in (determinant, PRIME - determinant)


@pytest.mark.parametrize("name", ["3_1", "m3_1", "4_1", "6_2", "9_42"])
def test_invariants_are_those_of_every_diagram(name):
    for diagram in views(knot(name, 60), 4, seed=3):
        simple = simplified(diagram)
        assert alexander(diagram) == alexander(simple)
        assert jones(diagram) == jones(simple)
        assert signature(diagram) == signature(simple)
        assert doubled_bracket(diagram) == doubled_bracket(simple)


def test_mirror_images_have_mirrored_polynomials():
    left, right = (braid_diagram(braid_word(name)) for name in ("m6_2", "6_2"))
    for polynomial in (jones, doubled_bracket):
        assert polynomial(left) == {-power: c for power, c in polynomial(right).items()}
    assert signature(left) == -signature(right)


def test_what_is_too_large_is_not_computed():
    assert alexander(braid_diagram((1,) * (MAX_CROSSINGS + 1))) is None
    assert jones(braid_diagram(tuple(range(1, 14)) * 14)) is None


def test_quick_invariants_tell_knots_apart_and_are_kept_by_scrambles_and_turns():
    """Δ = t − 1 + t⁻¹ is −2 at a cube root of unity."""
    assert quick_invariants(knot("3_1")).alexander[0][1] == 2
    assert quick_invariants(knot("4_1")) != quick_invariants(knot("5_1"))
    assert quick_invariants(knot("3_1")) != quick_invariants(knot("8_19"))
    assert not quick_invariants(torus_knot(3, 5)).is_trivial  # determinant 1
    assert [abs(x) for x in quick_invariants(hopf_link(20)).linking] == [1]
    assert quick_invariants(knot("L6a4")).linking == (0, 0, 0)
    curve = knot("6_2")
    expected = quick_invariants(curve)
    assert quick_invariants(scramble(curve, seed=5, moves=300)) == expected
    q, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    q[:, 0] *= np.sign(np.linalg.det(q))
    assert quick_invariants(curve.with_vertices(curve.vertices @ q)) == expected


@pytest.mark.parametrize(
    "curve", [regular_polygon(50), spiral(5.0), hard_unknot(60, 7)], ids=["circle", "spiral", "60"]
)
def test_unknots(curve):
    assert quick_invariants(curve).is_trivial


def test_strands_that_nearly_touch_are_told_apart_and_no_others():
    gap = 1e-12
    curve = Curve([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, gap], [0.0, 1.0, gap]])
    assert quick_invariants(curve).is_trivial
    once = knot("3_1").vertices
    with pytest.raises(CurveError, match="no view of the curve shows which one is in front"):
        quick_invariants(Curve(np.concatenate([once, once])))
