"""Lower bounds of least energies that are proved, and below those of the curves that are known."""

from fractions import Fraction

import pytest
from mobius_flow.core.knots import KNOTS
from mobius_flow.core.knots.shapes import least_energies
from mobius_flow.lab.smooth.least import lower_bound

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
