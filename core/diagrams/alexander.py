"""Alexander polynomials of diagrams, from values modulo a prime at roots of unity."""

import numpy as np

from ..types import IntArray
from .diagram import Diagram

PRIME = 2_147_389_441  # below 2³¹, so that products fit 64 bits; 1 more than a multiple of 2¹⁰·3·5·7, orders of roots
_GENERATOR = 11
MAX_CROSSINGS = 60  # a few tenths of a second, growing with the fourth power


def alexander(knot: Diagram) -> tuple[int, ...] | None:
    """Coefficients of the Alexander polynomial of a knot, positive at t = 1; None for too many crossings.

    From det(A), A the matrix of the arcs' relations at the crossings without a row and a column (Alexander, *Trans.
    AMS* 30, 1928): each says (1 − t) a + t b − c = 0 for the upper arc a and the lower ones b, c on its two sides.
    """
    if knot.crossings > MAX_CROSSINGS:
        return None
    if knot.crossings < 3:
        return (1,)
    order = 1 << knot.crossings.bit_length()
    powers = np.array([pow(root_of_unity(order), k, PRIME) for k in range(order)], dtype=np.int64)
    exponents = np.outer(np.arange(order), -np.arange(order)) % order
    found = (powers[exponents] * values(knot, powers) % PRIME).sum(axis=1) % PRIME * pow(order, -1, PRIME) % PRIME
    signed = np.where(found > PRIME // 2, found - PRIME, found)
    kept = np.trim_zeros(signed)
    return tuple((kept if kept.sum() > 0 else -kept).tolist())


def values(knot: Diagram, t: IntArray) -> IntArray:
    """Values of the Alexander polynomial of a knot, each up to a unit ±tᵏ, modulo the prime; shape (len(t),)."""
    return _determinants(_matrices(knot, t))


def root_of_unity(order: int) -> int:
    """A primitive root of unity modulo the prime, of an order that divides PRIME − 1."""
    return pow(_GENERATOR, (PRIME - 1) // order, PRIME)


def _matrices(knot: Diagram, t: IntArray) -> IntArray:
    """The matrix for each t; shape (len(t), n − 1, n − 1)."""
    count, arc, arcs = knot.crossings, 0, []
    for _, over in knot.sequence:
        arcs.append(arc)  # that on which the pass is, and that comes in below at a lower pass
        arc = (arc + (not over)) % count
    rows, sign = np.arange(count), np.array(knot.signs, dtype=np.intp)
    lower, upper = np.array(arcs, dtype=np.intp)[np.array(knot.strands, dtype=np.intp).reshape(count, 2).T]
    after = (lower + 1) % max(count, 1)
    found = np.zeros((len(t), count, count), dtype=np.int64)
    found[:, rows, upper] += 1 - t[:, None]
    found[:, rows, np.where(sign > 0, lower, after)] += t[:, None]
    found[:, rows, np.where(sign > 0, after, lower)] -= 1
    return np.asarray(found[:, :-1, :-1] % PRIME)


def _determinants(matrices: IntArray) -> IntArray:
    """Determinants modulo the prime, by elimination of all matrices together, in place; shape (len(matrices),).

    Few rows of such matrices have an entry in the column that is eliminated; only those are touched.
    """
    found = np.ones(len(matrices), dtype=np.int64)
    every = np.arange(len(matrices))
    for k in range(matrices.shape[1]):
        row = k + np.argmax(matrices[:, k:, k] != 0, axis=1)
        upper = matrices[every, row, k:].copy()
        matrices[every, row, k:] = matrices[:, k, k:]
        pivot = upper[:, 0]
        found = found * np.where(row > k, -pivot, pivot) % PRIME
        inverse = np.array([pow(int(p), -1, PRIME) if p else 0 for p in pivot], dtype=np.int64)
        factors = matrices[:, k + 1 :, k] * inverse[:, None] % PRIME
        below = np.flatnonzero(factors.any(axis=0))
        change = factors[:, below, None] * upper[:, None, :] % PRIME
        matrices[:, k + 1 + below, k:] = (matrices[:, k + 1 + below, k:] - change) % PRIME
    return found
