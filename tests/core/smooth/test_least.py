"""Lower bounds of least energies that are proved, and below those of the curves that are known."""

from math import pi

import pytest
from mobius_flow.core.knots import KNOTS
from mobius_flow.core.knots.shapes import least_energies
from mobius_flow.core.smooth.least import lower_bound


@pytest.mark.parametrize(
    ("name", "exact"),
    [
        ("0_1", 4.0),
        ("m3_1", 4.0 + 6.0 * pi),
        ("10_165", 4.0 + 20.0 * pi),
        ("L2a1", 8.0 + 4.0 * pi**2),
        ("L5a1", 8.0 + 4.0 * pi**2),  # with linking number 0
        ("L6a5", 12.0 + 12.0 * pi**2),
        ("L6a4", 12.0),  # no two of the Borromean rings are linked
    ],
)
def test_by_crossings_and_linked_pairs(name, exact):
    assert exact * (1.0 - 3e-15) < lower_bound(name) <= exact


def test_below_every_energy_of_the_table_but_where_a_circle_or_hopf_link_attains_it():
    for name in KNOTS:
        energy, error = least_energies()[name]
        attained = name in ("0_1", "L2a1")
        assert (lower_bound(name) > energy - error - 1e-8) if attained else (lower_bound(name) < energy - error)
