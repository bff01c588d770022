"""Alexander polynomials straight from braid words, by the Burau representation: no geometry involved."""

from collections.abc import Sequence
from fractions import Fraction

_BASE = 10**15  # t is set to this number, whose digits are then the coefficients


def burau_alexander(word: Sequence[int], strands: int) -> tuple[int, ...]:
    """Alexander polynomial of a closed braid, lowest coefficient first, positive at t = 1 or else at its start.

    det(1 − ψ) = (1 + t + … + t^(n−1)) Δ(t) for the reduced Burau matrix ψ (Burau 1936; Birman 1974, section 3.3).
    """
    size = strands - 1
    product = _identity(size)
    for letter in word:
        product = _times(product, _reduced_burau(letter, size))
    difference = [[Fraction(int(i == j)) - product[i][j] for j in range(size)] for i in range(size)]
    value = _determinant(difference) / sum(Fraction(_BASE) ** k for k in range(strands))
    value *= Fraction(_BASE) ** len(word)  # inverse letters bring powers of 1/t
    assert value.denominator == 1
    return _normalized(_digits(int(value)))


def _reduced_burau(letter: int, size: int) -> list[list[Fraction]]:
    i, t = abs(letter) - 1, Fraction(_BASE)
    matrix = _identity(size)
    one = Fraction(1)
    row = {i - 1: t, i: -t, i + 1: one} if letter > 0 else {i - 1: one, i: -1 / t, i + 1: 1 / t}
    for j, value in row.items():
        if 0 <= j < size:
            matrix[i][j] = value
    return matrix


def _identity(size: int) -> list[list[Fraction]]:
    return [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]


def _times(a: list[list[Fraction]], b: list[list[Fraction]]) -> list[list[Fraction]]:
    return [
        [sum((x * y for x, y in zip(row, column, strict=True)), Fraction(0)) for column in zip(*b, strict=True)]
        for row in a
    ]


def _determinant(matrix: list[list[Fraction]]) -> Fraction:
    rows, value = [list(row) for row in matrix], Fraction(1)
    for k in range(len(rows)):
        pivot = next((i for i in range(k, len(rows)) if rows[i][k]), None)
        if pivot is None:
            return Fraction(0)
        if pivot != k:
            rows[k], rows[pivot], value = rows[pivot], rows[k], -value
        value *= rows[k][k]
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return value


def _digits(value: int) -> list[int]:
    """Digits in balanced base, lowest first."""
    digits = []
    while value:
        digit = (value + _BASE // 2) % _BASE - _BASE // 2
        digits.append(digit)
        value = (value - digit) // _BASE
    return digits


def _normalized(digits: list[int]) -> tuple[int, ...]:
    while digits and not digits[0]:
        digits = digits[1:]
    sign = 1 if (sum(digits) or next(iter(digits), 1)) > 0 else -1
    return tuple(sign * digit for digit in digits)
