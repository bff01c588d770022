"""Alexander polynomials of diagrams, from values modulo primes at roots of unity."""

from itertools import accumulate
from math import prod
from operator import mul
from typing import NamedTuple

import numpy as np

from ..types import IntArray
from .diagram import Diagram

MAX_CROSSINGS = 60  # some hundredths of a second


class Field(NamedTuple):
    """The integers modulo a prime below 2³¹, so that products fit 64 bits, with a generator of the units."""

    prime: int
    generator: int

    def root_of_unity(self, order: int) -> int:
        """A primitive root of unity, of an order that divides the number of units."""
        return pow(self.generator, (self.prime - 1) // order, self.prime)


# primes that are 1 more than a multiple of 2¹⁰·3·5·7, orders of roots; together enough for MAX_CROSSINGS
FIELDS = Field(2_147_389_441, 11), Field(2_147_281_921, 38), Field(2_146_959_361, 19)


def alexander(knot: Diagram) -> tuple[int, ...] | None:
    """Coefficients of the Alexander polynomial of a knot, positive at t = 1; None for too many crossings.

    From det(A), A the matrix of the arcs' relations at the crossings without a row and a column (Alexander, *Trans.
    AMS* 30, 1928): each says (1 − t) a + t b − c = 0 for the upper arc a and the lower ones b, c on its two sides.
    Where |t| = 1 rows have at most the length √6, so that coefficients are at most √6ⁿ⁻¹ (Hadamard), and as many primes
    are taken as distinguish these.
    """
    if knot.crossings > MAX_CROSSINGS:
        return None
    if knot.crossings < 3:
        return (1,)
    moduli = accumulate((field.prime for field in FIELDS), mul)
    most = 6 ** (knot.crossings - 1)
    fields = FIELDS[: 1 + next(k for k, modulus in enumerate(moduli) if modulus**2 > 4 * most)]
    found = _lifted([_coefficients(knot, field).tolist() for field in fields], fields)
    kept = np.trim_zeros(found)
    return tuple(kept if sum(kept) > 0 else (-x for x in kept))


def alexander_values(knot: Diagram, t: IntArray, field: Field) -> IntArray:
    """Values of the Alexander polynomial of a knot, each up to a unit ±tᵏ, modulo a prime; shape (len(t),)."""
    return _determinants(_matrices(knot, t, field.prime), field.prime)


def _coefficients(knot: Diagram, field: Field) -> IntArray:
    """Those of the determinant modulo a prime, by the inverse Fourier transform of its values."""
    order, prime = 1 << knot.crossings.bit_length(), field.prime
    powers = np.array([pow(field.root_of_unity(order), k, prime) for k in range(order)], dtype=np.int64)
    exponents = np.outer(np.arange(order), -np.arange(order)) % order
    transformed = (powers[exponents] * alexander_values(knot, powers, field) % prime).sum(axis=1)
    return np.asarray(transformed % prime * pow(order, -1, prime) % prime)


def _lifted(residues: list[list[int]], fields: tuple[Field, ...]) -> list[int]:
    """The integers of least absolute value that have these residues modulo the primes (Chinese remainder theorem)."""
    modulus = prod(field.prime for field in fields)
    rests = [modulus // field.prime for field in fields]
    ones = [rest * pow(rest, -1, field.prime) for rest, field in zip(rests, fields, strict=True)]
    sums = (sum(x * one for x, one in zip(each, ones, strict=True)) % modulus for each in zip(*residues, strict=True))
    return [x - modulus if 2 * x > modulus else x for x in sums]


def _matrices(knot: Diagram, t: IntArray, prime: int) -> IntArray:
    """The matrix for each t modulo a prime; shape (len(t), n − 1, n − 1)."""
    count, arc, arcs = knot.crossings, 0, []
    for _, over in knot.sequence:
        arcs.append(arc)  # that on which the pass is, and that comes in below at a lower pass
        arc = (arc + (not over)) % count
    rows, sign = np.arange(count), np.array(knot.signs, dtype=np.intp)
    lower, upper = np.array(arcs, dtype=np.intp)[np.array(knot.levels, dtype=np.intp).reshape(count, 2).T]
    after = (lower + 1) % max(count, 1)
    found = np.zeros((len(t), count, count), dtype=np.int64)
    found[:, rows, upper] += 1 - t[:, None]
    found[:, rows, np.where(sign > 0, lower, after)] += t[:, None]
    found[:, rows, np.where(sign > 0, after, lower)] -= 1
    return np.asarray(found[:, :-1, :-1] % prime)


def _determinants(matrices: IntArray, prime: int) -> IntArray:
    """Determinants modulo a prime, all together, in place; only the few rows with an entry to eliminate are touched."""
    found = np.ones(len(matrices), dtype=np.int64)
    every = np.arange(len(matrices))
    for k in range(matrices.shape[1]):
        row = k + np.argmax(matrices[:, k:, k] != 0, axis=1)
        upper = matrices[every, row, k:].copy()
        matrices[every, row, k:] = matrices[:, k, k:]
        pivot = upper[:, 0]
        found = found * np.where(row > k, -pivot, pivot) % prime
        inverse = np.array([pow(int(p), -1, prime) if p else 0 for p in pivot], dtype=np.int64)
        factors = matrices[:, k + 1 :, k] * inverse[:, None] % prime
        below = np.flatnonzero(factors.any(axis=0))
        change = factors[:, below, None] * upper[:, None, :] % prime
        matrices[:, k + 1 + below, k:] = (matrices[:, k + 1 + below, k:] - change) % prime
    return found
