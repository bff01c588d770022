"""The tests' own instruments: simplified diagrams are of the same knot, and shortening keeps the type."""

import numpy as np
import pytest
from knot_diagrams import diagram, jones, linking_number
from knot_moves import simplified
from knot_type import UNKNOT, knot_invariants, shortened, small_diagram
from mobius_flow.core.knots import hard_unknot, knot, scramble

NAMES = ["0_1", "3_1", "m3_1", "4_1", "5_2", "6_2", "7_7", "8_19", "9_42", "3_1#m4_1"]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", [1, 3, 5])
def test_simplified_diagrams_have_the_same_jones_polynomial(name: str, seed: int) -> None:
    points = knot(name, 100).vertices
    turned = points + 0.4 * np.random.default_rng(seed).normal(size=3) * np.sin(3 * points[:, [1, 2, 0]])
    expected = jones(diagram([turned], projections=12))
    messy = max((diagram([turned], projections=2, seed=seed + k) for k in range(8)), key=lambda d: len(d.signs))
    simple = simplified(messy, enough=0, rounds=30, seed=seed)
    assert len(simple.signs) <= len(messy.signs)
    assert jones(simple) == expected


@pytest.mark.parametrize("name", NAMES)
def test_messy_and_neat_polygons_agree(name: str) -> None:
    curve = knot(name, 80)
    messy = scramble(curve, 3, moves=800)
    assert knot_invariants(messy.vertices) == knot_invariants(curve.vertices)
    assert len(shortened([messy.vertices])[0]) < 60


def test_hard_unknots_come_out_as_unknots() -> None:
    points = hard_unknot(80, 5).vertices
    assert len(diagram([points], projections=1).signs) > 60
    assert len(small_diagram([points]).signs) <= 20
    assert knot_invariants(points) == UNKNOT


def test_linking_numbers_change_sign_with_orientation_and_mirror_image() -> None:
    a, b = knot("T(2,6)").components
    assert linking_number(a, b) == 3
    assert linking_number(a[::-1], b) == -3
    assert linking_number(a * [1, 1, -1], b * [1, 1, -1]) == -3
