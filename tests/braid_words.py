"""Alexander polynomials straight from braid words, by the Burau representation: no geometry involved."""

from collections.abc import Sequence

from sympy import QQ
from sympy.polys.matrices import DomainMatrix


def burau_alexander(word: Sequence[int], strands: int) -> tuple[int, ...]:
    """Alexander polynomial of a closed braid, lowest coefficient first, positive at t = 1 or else at its start.

    det(1 − ψ) = (1 + t + … + t^(n−1)) Δ(t) for the reduced Burau matrix ψ (Burau 1936; Birman 1974, section 3.3).
    """
    if strands == 1:
        return (1,)
    base = 10**15  # t is set to this number, whose digits are then the coefficients
    size, t, one = strands - 1, QQ(base), QQ(1)
    identity = product = DomainMatrix.eye(size, QQ).to_dense()
    for letter in word:
        i, rows = abs(letter) - 1, identity.to_list()
        row = {i - 1: t, i: -t, i + 1: one} if letter > 0 else {i - 1: one, i: -one / t, i + 1: one / t}
        rows[i] = [row.get(j, 0 * one) for j in range(size)]
        product = product * DomainMatrix(rows, (size, size), QQ)
    value = (identity - product).det() / sum(t**k for k in range(strands)) * t ** len(word)  # without powers of 1/t
    assert value.denominator == 1
    rest, digits = int(value), list[int]()
    while rest:
        digit = (rest + base // 2) % base - base // 2  # digits may be negative
        digits += [digit] if digits or digit else []
        rest = (rest - digit) // base
    sign = 1 if (sum(digits) or next(iter(digits), 1)) > 0 else -1
    return tuple(sign * digit for digit in digits)
