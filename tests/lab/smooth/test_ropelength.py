"""Ropelengths of smooth curves, and what no rope or energy of a type is below."""

from fractions import Fraction

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh
from mobius_flow.core.collision import thickness
from mobius_flow.core.knots import KNOTS, knot
from mobius_flow.core.knots.shapes import least_energies
from mobius_flow.lab.smooth.least import lower_bound
from mobius_flow.lab.smooth.ropelength import bound_by_arcs, ropelength_bound
from shapes import regular_polygon

RING = np.exp(2j * np.pi * np.arange(60) / 60)
CIRCLE = np.stack([RING.real, RING.imag, 0 * RING.real], axis=1)
HOPF = Curve.from_components([CIRCLE, CIRCLE[:, [0, 2, 1]] + [1.0, 0.0, 0.0]])


def over_a_corner():
    """A circle that is nearer to an arc in a corner of a polygon than to its edges."""
    ring, turn = (np.exp(2j * np.pi * np.arange(n) / n)[:, None] for n in (16, 80))
    x, y, z = np.eye(3)
    up, along = (0.9375**0.5) * z - 0.25 * x, (0.9375**0.5) * x + 0.25 * z
    circle = x + 1.86 * up + 2.0 * (turn.imag * along + (1.0 - turn.real) * up)
    return Curve.from_components([(ring.real * x + ring.imag * y) / np.cos(np.pi / 16), circle])


def dense_thickness(curve, radius, samples):
    """Half the least distance between samples of the curve with arcs that are π radii apart along it."""
    points, along, part = [], [], []
    for number, p in enumerate(curve.components):
        u = np.roll(p, -1, axis=0) - p
        u /= np.linalg.norm(u, axis=1)[:, None]
        made = []
        for corner, before, after in zip(p, np.roll(u, 1, axis=0), u, strict=True):
            half = 0.5 * np.arccos(before @ after)
            centre = corner + radius * (after - before) / np.linalg.norm(after - before) / np.cos(half)
            first = corner - radius * np.tan(half) * before
            t = np.linspace(0.0, 2.0 * half, 7)[:, None]
            made += [*(centre + np.cos(t) * (first - centre) + radius * np.sin(t) * before)]
        ends = np.roll(made, -1, axis=0)
        s = np.arange(samples)[:, None, None] / samples
        x = (np.array(made) + s * (ends - made)).transpose(1, 0, 2).reshape(-1, 3)
        length = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
        points, along = [*points, *x], [*along, *(np.cumsum(length) - length)]
        part += [(number, length.sum())] * len(x)
    x, s, (number, whole) = np.array(points), np.array(along), np.array(part).T
    apart = np.abs(s[:, None] - s)
    apart = np.where(number[:, None] == number, np.minimum(apart, whole - apart), np.inf)
    return 0.5 * np.linalg.norm(x[:, None] - x, axis=2)[apart >= np.pi * radius].min()


@pytest.mark.parametrize(
    ("curve", "samples"),
    [(over_a_corner(), 2), (HOPF, 2), (knot("3_1", 60), 3)],
    ids=["over a corner", "Hopf link", "trefoil"],
)
def test_curves_with_arcs_are_as_thick_as_is_proved(curve, samples):
    radius = curve.length / bound_by_arcs(curve)
    assert radius > 0.85 * thickness(curve)
    assert radius <= dense_thickness(curve, radius, samples) * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("curve", "least", "error"),
    [(HOPF, 8.0 * np.pi, 5e-3), (Curve(CIRCLE), 2.0 * np.pi, 5e-3), (knot("3_1", 200), 32.7, 1.0)],
    ids=["Hopf link", "circle", "trefoil"],
)
def test_bounds_are_not_below_what_is_known(curve, least, error):
    bound = ropelength_bound(curve)
    assert least <= bound < (1.0 + error) * least
    assert bound < curve.length / thickness(curve) * (1.0 + 1e-3)


@pytest.mark.parametrize("curve", [regular_polygon(12, 2), Curve(CIRCLE, Mesh((60,), (False,)))], ids=["plane", "arc"])
def test_what_has_no_ropelength_is_refused(curve):
    with pytest.raises(CurveError):
        ropelength_bound(curve)


def test_a_spline_that_may_be_another_knot_bounds_nothing():
    hook = np.array([[-5.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-5.0, 1.0, 0.0]])
    with pytest.raises(CurveError, match="another knot"):
        ropelength_bound(Curve.from_components([hook, hook[:, [0, 2, 1]] * [-1.0, 1.0, 1.0] + [1.9, 0.0, 0.0]]))


PI = Fraction("3.14159265358979323846264338327950288")


@pytest.mark.parametrize(
    ("name", "exact"),
    [
        ("0_1", 4),
        ("m3_1", 4 + 6 * PI),
        ("10_165", 4 + 20 * PI),
        ("L2a1", 8 + 4 * PI**2),
        ("L5a1", 8 + 4 * PI**2),  # with linking number 0
        ("L6a5", 12 + 12 * PI**2),
        ("L6a4", 12),  # no two of the Borromean rings are linked
    ],
)
def test_by_crossings_and_linked_pairs(name, exact):
    assert Fraction(0) <= exact - Fraction(lower_bound(name)) < Fraction("3e-15") * exact


def test_knots_of_any_crossing_number_have_rounded_down_bounds():
    for c in range(3, 11):
        assert Fraction(lower_bound(f"{c}_1")) < 4 + 2 * c * PI


def test_below_every_energy_of_the_table_but_where_a_circle_or_hopf_link_attains_it():
    for name in KNOTS:
        energy, error = least_energies()[name]
        attained = name in ("0_1", "L2a1")
        assert (lower_bound(name) > energy - error - 1e-8) if attained else (lower_bound(name) < energy - error)
