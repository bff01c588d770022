"""Kauffman's bracket, the Jones polynomials of a knot and of the knot doubled, and Alexander polynomials.

The bracket (Kauffman, *Topology* 26, 1987) is contracted crossing by crossing: a state says how the edges that are cut
are paired so far, of which there are few if neighbouring crossings follow each other, and its value is a polynomial in
q = A².  Polynomials are packed in integers, their values at a large power of two.

Alexander polynomials come from values modulo primes at roots of unity.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import accumulate, product
from math import prod
from operator import mul
from typing import NamedTuple

import numpy as np

from ..types import IntArray
from .diagram import Diagram, Pass

Laurent = Mapping[int, int]  # exponent to coefficient, which is not 0
_State = frozenset[tuple[int, int]]  # both ends of every open arc, each with the other one

_LOOP = {2: -1, -2: -1}  # −A² − A⁻²
_MAX_WIDTH = 18  # edges cut at a time, of which there are up to 4862 pairings; doubles of small knots have 12 to 14
_STARTS = 10_000  # every crossing is tried as the first one of a diagram whose number of crossings, squared, is below
_BITS = 3  # by which coefficients may grow with a crossing: two smoothings, each with up to two loops −q − 1/q
_SHIFT = 5  # power of A for every crossing that keeps powers of q from being negative, whichever loops are closed
MAX_CROSSINGS = 60  # some hundredths of a second


def jones(diagram: Diagram) -> Laurent | None:
    """Jones polynomial by powers of √t, t + t³ − t⁴ for the right-handed trefoil; None if the diagram is too wide."""
    found = normalized_bracket(diagram, diagram.writhe)
    return None if found is None else {-power // 2: found[power] for power in sorted(found, reverse=True)}


def normalized_bracket(diagram: Diagram, writhe: int) -> Laurent | None:
    """(−A³)^−w ⟨D⟩ by powers of A; None if too wide.  With w of own crossings alone orientations do not matter."""
    found, sign = _bracket(diagram), -1 if writhe % 2 else 1
    return None if found is None else {power - 3 * writhe: sign * c for power, c in found.items()}


def doubled_bracket(knot: Diagram) -> Laurent | None:
    """The bracket of a knot in colour 2, by powers of A, normalised for framing 0; None if the diagram is too wide.

    Two strands are the projector of colour 2 and a part that makes a single loop of them; a twist of the ribbon
    multiplies the former by A⁸ (Kauffman and Lins, *Temperley–Lieb Recoupling Theory*, 1994, section 4.3).
    """
    found = _bracket(doubled(knot))
    if found is None:
        return None
    both = times(found, _LOOP)
    both[0] = both.get(0, 0) - 1
    return {power - 8 * knot.writhe: c for power, c in both.items() if c}


def doubled(diagram: Diagram) -> Diagram:
    """Every strand replaced by two side by side, the left one first, in the plane of the diagram."""
    passes: list[tuple[Pass, ...]] = []
    for part, side in product(diagram.passes, (0, 1)):
        strand: list[Pass] = []
        for crossing, over in part:
            # The one that goes over a positive crossing comes from the left, that below from the right.
            order = (0, 1) if over == (diagram.signs[crossing] > 0) else (1, 0)
            corners = ((other, side) if over else (side, other) for other in order)
            strand += [(4 * crossing + 2 * below + above, over) for below, above in corners]
        passes.append(tuple(strand))
    return Diagram(tuple(passes), tuple(sign for sign in diagram.signs for _ in range(4)))


def _bracket(diagram: Diagram) -> dict[int, int] | None:
    """The sum over all smoothings by powers of A, 1 for a circle; None if too many edges are cut on the way."""
    code: list[Sequence[int]] = list(diagram.planar_code)
    loops = sum(not part for part in diagram.passes)
    if code:
        code[0] = (-1, *code[0][1:])  # cut open, the last loop counts 1, not −A² − A⁻²
    else:
        loops -= 1
    starts = range(0, max(len(code), 1), 1 + len(code) ** 2 // _STARTS)
    order, width = min((_order(code, start) for start in starts), key=lambda found: found[1])
    if width > _MAX_WIDTH:
        return None
    bits = _BITS * len(code) + 2
    states: dict[_State, int] = {frozenset(): 1}
    for crossing in order:
        states = _smoothed(states, crossing, bits)
    (value,) = states.values()
    found = {2 * k - _SHIFT * len(code): c for k, c in _unpacked(value, bits) if c}
    for _ in range(loops):
        found = times(found, _LOOP)
    return found


def times(a: Laurent, b: Laurent) -> dict[int, int]:
    """The product of two Laurent polynomials."""
    found: dict[int, int] = {}
    for (i, x), (j, y) in product(a.items(), b.items()):
        found[i + j] = found.get(i + j, 0) + x * y
    return {power: c for power, c in found.items() if c}


def _order(code: Sequence[Sequence[int]], start: int) -> tuple[list[Sequence[int]], int]:
    """From a crossing on, always the next one that most edges lead to; and how many edges are cut at a time at most."""
    rest, order, width = list(code), list[Sequence[int]](), 0
    cut = set(code[start]) if code else set()
    while rest:
        crossing = max(rest, key=lambda edges: len(cut.intersection(edges)))
        rest.remove(crossing)
        order.append(crossing)
        if len(order) == 1:
            cut.clear()
        for edge in crossing:
            cut ^= {edge}
        width = max(width, len(cut))
    return order, width


def _smoothed(states: Mapping[_State, int], crossing: Sequence[int], bits: int) -> dict[_State, int]:
    """Both smoothings of a crossing, A times one and 1/A times the other, and A⁵ times both."""
    a, b, c, d = crossing
    found: dict[_State, int] = {}
    for power, arcs in ((3, ((a, b), (c, d))), (2, ((a, d), (b, c)))):
        for state, value in states.items():
            ends = dict(state)
            loops = sum(_closes(ends, *arc) for arc in arcs)
            value <<= bits * (power - loops)
            for _ in range(loops):
                value = -value - (value << 2 * bits)
            joined = frozenset(ends.items())
            found[joined] = found.get(joined, 0) + value
    return found


def _closes(ends: dict[int, int], a: int, b: int) -> bool:
    """Join the two edges to the open arcs; whether that closes a loop."""
    if ends.get(a) == b:
        del ends[a], ends[b]
        return True
    if a == b:
        return True
    first, last = ends.pop(a, a), ends.pop(b, b)
    ends[first], ends[last] = last, first
    return False


def _unpacked(value: int, bits: int) -> Iterator[tuple[int, int]]:
    """The digits, lowest first, of a number whose digits have signs."""
    half, power = 1 << (bits - 1), 0
    while value:
        digit = ((value + half) & (2 * half - 1)) - half
        yield power, digit
        value, power = (value - digit) >> bits, power + 1


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
