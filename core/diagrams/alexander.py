"""Alexander polynomials of diagrams, from values modulo a prime at roots of unity."""

import numpy as np

from ..types import IntArray
from .diagram import Diagram

PRIME = 998_244_353  # 119·2²³ + 1, so that it has roots of unity of all orders that are powers of 2
_GENERATOR = 3
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
    root = pow(_GENERATOR, (PRIME - 1) // order, PRIME)
    powers = np.array([pow(root, k, PRIME) for k in range(order)], dtype=np.int64)
    values = _determinants(_matrices(knot, powers))
    exponents = np.outer(np.arange(order), -np.arange(order)) % order
    found = (powers[exponents] * values % PRIME).sum(axis=1) % PRIME * pow(order, -1, PRIME) % PRIME
    signed = np.where(found > PRIME // 2, found - PRIME, found)
    kept = np.trim_zeros(signed)
    return tuple((kept if kept.sum() > 0 else -kept).tolist())


def _matrices(knot: Diagram, t: IntArray) -> IntArray:
    """The matrix for each t; shape (len(t), n − 1, n − 1)."""
    count, arc, arcs = knot.crossings, 0, []
    for _, over in knot.sequence:
        arcs.append(arc)  # that on which the pass is, and that comes in below at a lower pass
        arc = (arc + (not over)) % count
    found = np.zeros((len(t), count, count), dtype=np.int64)
    for row, ((lower, upper), sign) in enumerate(zip(knot.strands, knot.signs, strict=True)):
        before, after = arcs[lower], (arcs[lower] + 1) % count
        first, second = (before, after) if sign > 0 else (after, before)
        found[:, row, arcs[upper]] += 1 - t
        found[:, row, first] += t
        found[:, row, second] -= 1
    return np.asarray(found[:, :-1, :-1] % PRIME)


def _determinants(matrices: IntArray) -> IntArray:
    """Determinants modulo the prime, by elimination of all matrices together; shape (len(matrices),)."""
    found = np.ones(len(matrices), dtype=np.int64)
    every = np.arange(len(matrices))
    while matrices.shape[1]:
        row = np.argmax(matrices[:, :, 0] != 0, axis=1)
        swapped = matrices[every, row].copy()
        matrices[every, row] = matrices[:, 0]
        pivot = swapped[:, 0]
        found = found * np.where(row > 0, -pivot, pivot) % PRIME
        inverse = np.array([pow(int(p), -1, PRIME) if p else 0 for p in pivot], dtype=np.int64)
        factors = matrices[:, 1:, 0] * inverse[:, None] % PRIME
        matrices = (matrices[:, 1:, 1:] - factors[:, :, None] * swapped[:, None, 1:]) % PRIME
    return found
