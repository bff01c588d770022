"""Cables and doubles: known types around the circle, known polynomials around other knots; and Lissajous knots."""

import numpy as np
import pytest
from families import crossed
from knot_diagrams import pairwise_linking
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.knots import cable, double, knot, lissajous_knot, smooth_knot, torus_knot
from mobius_flow.core.knots.formulas import MAX_STRANDS, SolidTorus
from shapes import regular_polygon

CIRCLE = regular_polygon(100)


@pytest.mark.parametrize(("p", "q"), [(2, 3), (2, -3), (2, 1), (2, -1), (3, 2), (3, -4), (2, 5)])
def test_cables_of_the_circle_are_torus_knots_and_of_a_trefoil_have_its_polynomial(p, q):
    torus = knot_invariants(torus_knot(p, q).vertices)
    assert knot_invariants(cable(CIRCLE, p, q).vertices) == torus
    if p == 2:
        found = knot_invariants(cable(smooth_knot("3_1"), 2, q).vertices)
        assert found.alexander == tuple(np.convolve((1, 0, -1, 0, 1), torus.alexander).tolist())


@pytest.mark.parametrize(("name", "turns"), crossed(["0_1", "3_1", "4_1", "7_4"], [(2, 0), (2, 4), (3, -3)]))
def test_links_of_parallel_strands(name, turns):
    p, q = turns
    link = cable(smooth_knot(name), p, q)
    parts = np.gcd(p, q)
    assert set(pairwise_linking(link.components).values()) == {p * q // parts**2}
    companion = knot_invariants(smooth_knot(name).vertices)
    if parts == p:
        assert all(knot_invariants(part) == companion for part in link.components)


@pytest.mark.parametrize("name", ["0_1", *(pytest.param(name, marks=pytest.mark.slow) for name in ("3_1", "m5_2"))])
@pytest.mark.parametrize(("twists", "clasp"), [(-2, 1), (-1, -1), (0, 1), (0, -1), (1, 1), (3, -1)])
def test_doubles_have_the_polynomial_of_their_twists(name, twists, clasp):
    curve = double(smooth_knot(name), twists, clasp=clasp)
    found, w = knot_invariants(curve.vertices), twists * clasp
    assert found.alexander == ((-w, 2 * w + 1, -w) if w else (1,))
    assert found.genus == (1 if w or name != "0_1" else 0)


def test_freedmans_unknot_is_an_unknot():
    assert knot_invariants(knot("Freedman unknot", 300).vertices) == UNKNOT
    assert 550 < len(knot("freedman")) < 650


def test_longitudes_do_not_link_the_knot_and_the_reach_of_a_circle_is_its_radius():
    assert SolidTorus.around(CIRCLE).reach == pytest.approx(1.0, rel=1e-3)
    for name in ("3_1", "m3_1", "6_2", "8_19"):
        curve = smooth_knot(name)
        tube, t = SolidTorus.around(curve), np.arange(400) / 400
        center, longitude = (tube.points(t, np.full(400, r), np.zeros(400)) for r in (0.0, 0.5 * tube.reach))
        assert pairwise_linking([center, longitude]) == {(0, 1): 0}
        assert np.linalg.norm(center - longitude, axis=1) == pytest.approx(0.5 * tube.reach, rel=0.01)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: cable(CIRCLE, 1, 3), "cable of 1 strands"),
        (lambda: cable(CIRCLE, MAX_STRANDS + 1, 3), "strands are 2 to"),
        (lambda: cable(CIRCLE, 2, 101), "turns -100 to 100"),
        (lambda: cable(CIRCLE, 5, 4, 9), "too few"),
        (lambda: cable(CIRCLE, 2, 3, 10**9), "too many"),
        (lambda: cable(torus_knot(2, 2), 2, 3), "one closed curve in space"),
        (lambda: cable(Curve(np.eye(3)[:, :2]), 2, 3), "one closed curve in space"),
        (lambda: double(CIRCLE, 101), "twists is 101"),
        (lambda: double(CIRCLE, 1, clasp=0), "clasp 1 or -1"),
        (lambda: lissajous_knot((2, 4, 5), (0.7, 0.2)), "common divisor"),
        (lambda: lissajous_knot((0, 1, 3), (0.7, 0.2)), "from 1 to 40"),
        (lambda: lissajous_knot((3, 4, 41), (0.7, 0.2)), "from 1 to 40"),
        (lambda: lissajous_knot((3, 4, 7), (0.0, 0.0)), "change a phase"),
        (lambda: lissajous_knot((3, 4, 7), (np.nan, 0.0)), "finite"),
    ],
)
def test_what_is_refused(make, said):
    with pytest.raises(CurveError, match=said):
        make()
