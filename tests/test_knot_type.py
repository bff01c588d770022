"""The tests' own instruments: messy polygons have the invariants of neat ones, and conventions are those of tables."""

import random

import numpy as np
import pytest
from families import crossed, family
from hard_curves import hard_unknot
from jones import jones
from knot_diagrams import diagram, linking_number, pairwise_linking, simplified
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core.knots import knot, scramble

NAMES = ["0_1", "3_1", "m3_1", "4_1", "5_2", "6_2", "7_7", "8_19", "9_42", "3_1#m4_1"]
TREFOIL = {2: 1, 6: 1, 8: -1}


@pytest.mark.parametrize(("name", "seed"), crossed(NAMES, [1, 3, 5]))
def test_the_jones_polynomial_is_that_of_every_diagram(name, seed):
    points = knot(name, 100).vertices
    turned = points + 0.4 * np.random.default_rng(seed).normal(size=3) * np.sin(3 * points[:, [1, 2, 0]])
    messy = max((diagram([turned], projections=2, seed=seed + k) for k in range(8)), key=lambda d: len(d.signs))
    simple = simplified([turned])
    assert len(simple.crossings) <= len(messy.signs)
    assert jones(simple) == jones(messy.link())


def test_the_jones_polynomial_is_in_the_convention_of_tables():
    assert jones(simplified([knot("3_1").vertices])) == TREFOIL
    assert jones(simplified([knot("m3_1").vertices])) == {-power: c for power, c in TREFOIL.items()}
    assert jones(simplified([knot("0_1").vertices])) == {0: 1}


def test_components_apart_count_as_loops():
    circle = knot("0_1", 30).vertices
    apart = [circle, circle + 5.0]
    assert jones(diagram(apart).link()) == jones(simplified(apart)) == {-1: -1, 1: -1}
    with_trefoil = jones(simplified([knot("3_1", 60).vertices, circle + 5.0]))
    assert with_trefoil == {1: -1, 3: -1, 5: -1, 9: 1}  # (t + t³ − t⁴)(−t^½ − t^−½)


@pytest.mark.parametrize("name", family(NAMES, every=3))
def test_messy_and_neat_polygons_agree(name):
    curve = knot(name, 80)
    messy = scramble(curve, 3, moves=250)
    assert knot_invariants(messy.vertices) == knot_invariants(curve.vertices)


def test_hard_unknots_come_out_as_unknots():
    points = hard_unknot(80, 5).vertices
    assert len(diagram([points], projections=1).signs) > 60
    assert knot_invariants(points) == UNKNOT


def test_simplification_leaves_the_random_numbers_of_others_alone():
    random.seed(7)
    wanted = random.random()
    random.seed(7)
    simplified([knot("8_19").vertices])
    assert random.random() == wanted


def test_linking_numbers_change_sign_with_orientation_and_mirror_image():
    a, b = knot("T(2,6)").components
    assert linking_number(a, b) == 3
    assert linking_number(a[::-1], b) == -3
    assert linking_number(a * [1, 1, -1], b * [1, 1, -1]) == -3
    assert pairwise_linking([a, b, a + 50.0]) == {(0, 1): 3, (0, 2): 0, (1, 2): 0}
