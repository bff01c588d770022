"""Exact decisions: roots of polynomials, and segments that meet."""

import os
from fractions import Fraction

import numpy as np
import pytest
from degenerate_motions import crossing_shadows
from exact_decisions import meet, until
from mobius_flow.core.proof.checker import END, START, common_divisor, halved, roots, sign, times

CROSS = [[-1, 0, 1], [1, 0, 1], [0, -1, 0], [0, 1, 0]]
FLAT = [[0, 1], [1, 1], [0, 0], [1, 0]]
IN_A_ROW = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]


def moved(points, first, second):
    steps = (first, first, second, second)
    return [[x + d for x, d in zip(p, step, strict=True)] for p, step in zip(points, steps, strict=True)]


@pytest.mark.parametrize(
    ("start", "end", "contact"),
    [
        (CROSS, moved(CROSS, [0, 0, -4], [0, 0, 0]), 0.25),
        (CROSS, moved(CROSS, [0, 0, -1], [0, 0, 0]), 1),
        (CROSS, moved(CROSS, [0, 0, -0.999], [0, 0, 0]), None),
        (CROSS, moved(CROSS, [0, 1, -1], [0, 0, 0]), 1),  # over an end, exactly
        (CROSS, moved(CROSS, [0, 1.001, -1], [0, 0, 0]), None),
        (CROSS, moved(CROSS, [0, 4, -3], [0, 0, 0]), None),
        (FLAT, moved(FLAT, [0, -4], [0, 0]), 0.25),  # parallel, face to face
        (FLAT, moved(FLAT, [5, -1], [0, 0]), None),
        (FLAT, moved(FLAT, [1, -1], [0, 0]), 1),  # end to end
        (FLAT, [[1, 0], [1, 1], [0, 0], [1, 0]], 1),
        (IN_A_ROW, moved(IN_A_ROW, [4, 0, 0], [0, 0, 0]), 0.25),  # collinear
        (IN_A_ROW, moved(IN_A_ROW, [3, 0.001, 0], [0, 0, 0]), None),
        (IN_A_ROW, IN_A_ROW, None),
        (IN_A_ROW, moved(IN_A_ROW, [0, 7, 0], [0, 0, 7]), None),
        ([[0, 0], [2, 2], [0, 2], [2, 0]], [[0, 0], [2, 2], [0, 2], [2, 0]], 0),
        ([[0, 0, 0], [2, 0, 0], [1, 0, 0], [1, 1, 1]], [[9, 9, 9], [8, 8, 7], [1, 2, 3], [4, 4, 4]], 0),
        ([[0, 0], [0, 0], [1, 0], [1, 1]], [[2, 1], [2, 1], [1, 0], [1, 1]], 0.5),  # a point and an edge
        ([[0, 0], [0, 0], [1, 1], [1, 1]], [[2, 2], [2, 2], [1, 1], [1, 1]], 0.5),  # two points
    ],
)
def test_known_contacts(start, end, contact):
    assert meet(start, end) == (contact is not None)
    if contact is not None:
        assert until(meet, start, end, contact)
        assert contact == 0 or not until(meet, start, end, np.nextafter(contact, 0.0))


def test_contact_at_an_irrational_time():
    """The point (t, 0) meets the edge from (0, −1) to (2, 4t − 1) where 2t² = 1."""
    start, end = [[0, -1], [2, -1], [0, 0], [0, 0]], [[0, -1], [2, 3], [1, 0], [1, 0]]
    before, after = 0.7071067811865475, 0.7071067811865476
    assert [until(meet, start, end, t) for t in (before, after)] == [False, True]


def test_edges_that_meet_beside_a_multiple_root():
    """The polynomials have multiple roots where roots are told apart; MOBIUS_FLOW_SHADOWS=3000 makes more of them."""
    rng = np.random.default_rng(617)
    for _ in range(int(os.environ.get("MOBIUS_FLOW_SHADOWS", "300"))):
        start, end = crossing_shadows(rng)
        assert meet(start, end), (start.tolist(), end.tolist())


def linear(root):
    """A polynomial that increases and vanishes at a rational number."""
    return [-root.numerator, root.denominator - root.numerator]


def product(*factors):
    result = [1]
    for factor in factors:
        result = times(result, factor)
    return result


def interval(time):
    _, i, j, m = time
    return Fraction(i, m), Fraction(j, m)


def test_random_products():
    rng = np.random.default_rng(13)
    for _ in range(200):
        chosen = [Fraction(int(a), int(b)) for a, b in rng.integers([-3, 1], [9, 8], size=(rng.integers(1, 5), 2))]
        p = product(*map(linear, chosen), [3, 7, 5] if rng.random() < 0.5 else [-2])
        found = sorted(roots(p), key=interval)
        inside = sorted({x for x in chosen if 0 < x < 1})
        assert len(found) == len(inside)
        for root, x in zip(found, inside, strict=True):
            low, high = interval(root)
            assert low < x < high or low == x == high
            assert sign(linear(x), root) == 0
            assert sign(product(linear(x), [1, 1, 2]), root) == 0
            assert sign(linear(x + Fraction(1, 10**9)), root) < 0 < sign(linear(x - Fraction(1, 10**9)), root)
            for _ in range(5):
                if low < high:
                    low, high = interval(root := halved(root))
                    assert low < x < high or low == x == high


def test_irrational_roots():
    square = [-1, -2, 1]  # 2 t² − 1
    (root,) = roots(square)
    assert sign(square, root) == 0
    assert sign(product(square, [1, 2, 3]), root) == 0
    assert sign([-707107, 1000000 - 707107], root) < 0 < sign([-707106, 1000000 - 707106], root)


@pytest.mark.parametrize("gap", [0, 2**-90])
def test_double_root_and_close_roots(gap):
    half, near = Fraction(1, 2), Fraction(1, 2) + Fraction(gap)
    found = sorted(roots(product(linear(half), linear(half), linear(near))), key=interval)
    assert len(found) == 1 + bool(gap)
    assert sign(linear(half), found[0]) == 0 == sign(linear(near), found[-1])


@pytest.mark.parametrize("p", [[1], [1, 2, 2], [2, 1], [5, 7, 3], [0, 1], [1, 0]])
def test_no_roots_inside(p):
    assert list(roots(p)) == []


def test_signs_at_the_ends_and_of_nothing():
    assert (sign([0, 1], START), sign([3, -4], START), sign([1, 0], END), sign([3, -4], END)) == (0, 3, 0, -4)
    assert sign([0, 0], START) == 0


def test_greatest_common_divisor():
    p, q, r = [-1, 3], [2, 0, 1], [-5, 7]
    assert common_divisor(product(p, q), product(p, r)) in (p, [1, -3])
    assert len(common_divisor(q, r)) == 1
