"""Roots and signs against known factorisations."""

from fractions import Fraction

import numpy as np
import pytest
from mobius_flow.core.verify.polynomials import (
    ZERO,
    Polynomial,
    Root,
    add,
    count_roots,
    derivative,
    gcd,
    multiply,
    roots,
    sign_at,
    square_free,
    subtract,
)


def product(*factors: Polynomial) -> Polynomial:
    result: Polynomial = (1,)
    for factor in factors:
        result = multiply(result, factor)
    return result


def minus(root: Fraction) -> Polynomial:
    """The linear polynomial that vanishes at a rational number."""
    return (-root.numerator, root.denominator)


def test_arithmetic() -> None:
    assert multiply((1, 1), (-1, 1)) == (-1, 0, 1)
    assert multiply((), (1, 2)) == ()
    assert add((1, 2, 3), (0, 0, -3)) == (1, 2)
    assert subtract((1, 2), (1, 2)) == ()
    assert derivative((5, 0, 3, 2)) == (0, 6, 6)
    assert sign_at((-1, 0, 4), Fraction(1, 2)) == 0
    assert sign_at((-1, 0, 4), Fraction(-2, 3)) == 1
    assert sign_at((), Fraction(1, 3)) == 0


def test_greatest_common_divisor() -> None:
    p, q, r = (-1, 3), (2, 0, 1), (-5, 7)
    common = gcd(product(p, q), product(p, r))
    assert common in (p, (1, -3))
    assert len(gcd(q, r)) == 1


def test_random_products() -> None:
    rng = np.random.default_rng(13)
    for _ in range(200):
        chosen = [Fraction(int(a), int(b)) for a, b in rng.integers([-3, 1], [9, 8], size=(rng.integers(1, 5), 2))]
        p = product(*map(minus, chosen), (3, 1, 1) if rng.random() < 0.5 else (-2,))
        found = roots(p)
        inside = sorted({x for x in chosen if 0 <= x <= 1})
        assert len(found) == len(inside)
        for root, x in zip(found, inside, strict=True):
            assert root.low < x <= root.high
            assert root.sign_of(minus(x)) == 0
            assert root.sign_of(product(minus(x), (1, 0, 1))) == 0
            assert root.sign_of(minus(x + Fraction(1, 10**9))) == -1
            assert root.sign_of(minus(x - Fraction(1, 10**9))) == 1
            assert root.halved().low < x <= root.halved().high


def test_irrational_roots() -> None:
    (root,) = roots((-1, 0, 2))  # 1/√2
    assert root.sign_of((-1, 0, 2)) == 0
    assert root.sign_of((-1, 0, 0, 0, 4)) == 0  # 4t⁴ − 1 = (2t² − 1)(2t² + 1)
    assert root.sign_of((-707107, 1000000)) == -1
    assert root.sign_of((-707106, 1000000)) == 1
    assert count_roots((-1, 0, 2), Fraction(-1), Fraction(1)) == 2


def test_double_root_and_close_roots() -> None:
    near = Fraction(1, 2) + Fraction(1, 2**90)
    p = product(minus(Fraction(1, 2)), minus(Fraction(1, 2)), minus(near))
    first, second = roots(p)
    assert first.sign_of(minus(Fraction(1, 2))) == 0
    assert second.sign_of(minus(near)) == 0


@pytest.mark.parametrize("p", [(1,), (1, 0, 1), (2, -1), (5, -3, 1)])
def test_no_roots(p: Polynomial) -> None:
    assert roots(p) == []


def test_zero() -> None:
    assert ZERO.sign_of((0, 1)) == 0
    assert ZERO.sign_of((3, 1)) == 1
    assert ZERO.sign_of(()) == 0


@pytest.mark.parametrize("power", [1, 2, 3])
@pytest.mark.parametrize("end", [Fraction(0), Fraction(1, 2)])
def test_multiple_roots_at_the_ends_of_the_interval(end: Fraction, power: int) -> None:
    """Of two roots, one of them multiple and at an end: the lower end does not count, the upper one does."""
    inside = minus(Fraction(1, 4))
    q = product(inside, *[minus(end)] * power)
    assert count_roots(q, Fraction(0), Fraction(1, 2)) == (1 if end == 0 else 2)
    root = Root(minus(Fraction(1, 3)), Fraction(0), Fraction(1, 2))
    assert root.sign_of(q) == sign_at(q, Fraction(1, 3))
    root = Root(inside, Fraction(0), Fraction(1, 2))
    assert root.sign_of(q) == 0
    assert root.sign_of(product(*[minus(end)] * power)) == (1 if end == 0 else (-1) ** power)


@pytest.mark.parametrize("powers", [(1, 1), (2, 1), (1, 3), (2, 2)])
def test_square_free(powers: tuple[int, int]) -> None:
    p, q = (-1, 3), (1, 0, 5)
    found = square_free(product(*[p] * powers[0], *[q] * powers[1]))
    assert found in (product(p, q), multiply((-1,), product(p, q)))
