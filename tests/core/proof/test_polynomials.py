"""Roots and signs against known factorisations."""

from fractions import Fraction

import numpy as np
import pytest
from mobius_flow.core.proof.checker import END, START, Polynomial, Time, common_divisor, halved, roots, sign, times


def linear(root: Fraction) -> Polynomial:
    """A polynomial that increases and vanishes at a rational number."""
    return [-root.numerator, root.denominator - root.numerator]


def product(*factors: Polynomial) -> Polynomial:
    result = [1]
    for factor in factors:
        result = times(result, factor)
    return result


def interval(time: Time) -> tuple[Fraction, Fraction]:
    _, i, j, m = time
    return Fraction(i, m), Fraction(j, m)


def test_random_products() -> None:
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


def test_irrational_roots() -> None:
    square = [-1, -2, 1]  # 2 t² − 1
    (root,) = roots(square)
    assert sign(square, root) == 0
    assert sign(product(square, [1, 2, 3]), root) == 0
    assert sign([-707107, 1000000 - 707107], root) < 0 < sign([-707106, 1000000 - 707106], root)


@pytest.mark.parametrize("gap", [0, 2**-90])
def test_double_root_and_close_roots(gap: float) -> None:
    half, near = Fraction(1, 2), Fraction(1, 2) + Fraction(gap)
    found = sorted(roots(product(linear(half), linear(half), linear(near))), key=interval)
    assert len(found) == 1 + bool(gap)
    assert sign(linear(half), found[0]) == 0 == sign(linear(near), found[-1])


@pytest.mark.parametrize("p", [[1], [1, 2, 2], [2, 1], [5, 7, 3], [0, 1], [1, 0]])
def test_no_roots_inside(p: Polynomial) -> None:
    assert list(roots(p)) == []


def test_signs_at_the_ends_and_of_nothing() -> None:
    assert (sign([0, 1], START), sign([3, -4], START), sign([1, 0], END), sign([3, -4], END)) == (0, 3, 0, -4)
    assert sign([0, 0], START) == 0


def test_greatest_common_divisor() -> None:
    p, q, r = [-1, 3], [2, 0, 1], [-5, 7]
    assert common_divisor(product(p, q), product(p, r)) in (p, [1, -3])
    assert len(common_divisor(q, r)) == 1
