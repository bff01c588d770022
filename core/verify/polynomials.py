"""Polynomials with integer coefficients, their real roots in [0, 1], and exact signs at those roots.

A polynomial is a tuple of coefficients, lowest degree first, without leading zeros; () is the zero polynomial.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise

Polynomial = tuple[int, ...]


@dataclass(frozen=True)
class Root:
    """The only root in (low, high] of a square-free polynomial."""

    polynomial: Polynomial
    low: Fraction
    high: Fraction

    def halved(self) -> "Root":
        """The same root in half the interval."""
        middle = (self.low + self.high) / 2
        if count_roots(self.polynomial, self.low, middle):
            return Root(self.polynomial, self.low, middle)
        return Root(self.polynomial, middle, self.high)

    def sign_of(self, q: Polynomial) -> int:
        """Sign of the polynomial ``q`` at the root, exactly.

        It is 0 if and only if both have a common divisor with a root in the interval, for ours is the only root there.
        Otherwise the root has a neighbourhood without roots of ``q``. The interval comes to lie in it, except for its
        open lower end; so ``q`` has at the upper end the sign it has at the root.
        """
        if not q:
            return 0
        if count_roots(gcd(self.polynomial, q), self.low, self.high):
            return 0
        root = self
        while count_roots(q, root.low, root.high):
            root = root.halved()
        return sign_at(q, root.high)


ZERO = Root((0, 1), Fraction(-1), Fraction(0))
"""The number 0."""


def roots(p: Polynomial) -> list[Root]:
    """The different roots of a non-zero polynomial in [0, 1], in ascending order, each in an interval of its own."""
    if len(p) < 2 or _one_sign(p):
        return []
    p = square_free(p)
    found, work = [], [(Fraction(-1, 2**20), Fraction(1))]
    while work:
        low, high = work.pop()
        count = count_roots(p, low, high)
        if count == 1:
            found.append(Root(p, low, high))
        elif count > 1:
            middle = (low + high) / 2
            work += [(middle, high), (low, middle)]
    return [root for root in found if root.sign_of((0, 1)) >= 0]


def count_roots(p: Polynomial, low: Fraction, high: Fraction) -> int:
    """Number of different roots in (low, high] of a non-zero polynomial, by Sturm's theorem.

    The theorem is about the square-free part: where an end of the interval is a multiple root of p itself, all of p's
    own chain vanishes there, and counts nothing.
    """
    if len(p) < 2:
        return 0
    chain = _sturm_chain(p)
    return _changes([sign_at(q, low) for q in chain]) - _changes([sign_at(q, high) for q in chain])


def square_free(p: Polynomial) -> Polynomial:
    """The polynomial, up to a constant factor, that has the roots of a non-zero p, each of them once."""
    return _primitive(_divided(p, gcd(p, derivative(p)))[0])


@lru_cache(maxsize=256)
def _sturm_chain(p: Polynomial) -> tuple[Polynomial, ...]:
    """Sturm's chain of the square-free part of a polynomial that is not constant."""
    p = square_free(p)
    chain = [p, derivative(p)]
    while chain[-1]:
        chain.append(_primitive(tuple(-c for c in _divided(chain[-2], chain[-1])[1])))
    return tuple(chain[:-1])


def sign_at(p: Polynomial, t: Fraction) -> int:
    value, power = 0, 1
    for c in reversed(p):  # Horner's rule for p(a/b) b^degree, b > 0
        value = value * t.numerator + c * power
        power *= t.denominator
    return (value > 0) - (value < 0)


def gcd(p: Polynomial, q: Polynomial) -> Polynomial:
    """Greatest common divisor, up to a constant factor."""
    while q:
        p, q = q, _primitive(_divided(p, q)[1])
    return p


def derivative(p: Polynomial) -> Polynomial:
    return tuple(k * c for k, c in enumerate(p) if k)


def add(p: Polynomial, q: Polynomial) -> Polynomial:
    if len(p) < len(q):
        p, q = q, p
    return _trimmed([c + (q[k] if k < len(q) else 0) for k, c in enumerate(p)])


def subtract(p: Polynomial, q: Polynomial) -> Polynomial:
    return add(p, tuple(-c for c in q))


def multiply(p: Polynomial, q: Polynomial) -> Polynomial:
    product = [0] * (len(p) + len(q) - 1) if p and q else []
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return _trimmed(product)


def _one_sign(p: Polynomial) -> bool:
    """Whether the Bernstein coefficients on [0, 1] show that there is no root; a quick answer for most."""
    n = len(p) - 1
    scaled = [c * math.factorial(n) // math.comb(n, j) for j, c in enumerate(p)]
    bernstein = [sum(c * math.comb(k, j) for j, c in enumerate(scaled[: k + 1])) for k in range(n + 1)]
    return min(bernstein) > 0 or max(bernstein) < 0


def _changes(signs: list[int]) -> int:
    signs = [s for s in signs if s]
    return sum(a != b for a, b in pairwise(signs))


def _divided(p: Polynomial, q: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Quotient and remainder of p by q, both times the same positive number."""
    rest, quotient, scale = list(p), [0] * max(len(p) - len(q) + 1, 0), abs(q[-1])
    for shift in reversed(range(len(quotient))):
        factor = rest[shift + len(q) - 1] if q[-1] > 0 else -rest[shift + len(q) - 1]
        rest, quotient = [scale * c for c in rest], [scale * c for c in quotient]
        quotient[shift] = factor
        for k, c in enumerate(q):
            rest[shift + k] -= factor * c
    return tuple(quotient), _trimmed(rest)


def _primitive(p: Polynomial) -> Polynomial:
    """The polynomial divided by the (positive) common divisor of its coefficients."""
    divisor = math.gcd(*p)
    return tuple(c // divisor for c in p) if divisor > 1 else p


def _trimmed(p: list[int]) -> Polynomial:
    while p and p[-1] == 0:
        p.pop()
    return tuple(p)
