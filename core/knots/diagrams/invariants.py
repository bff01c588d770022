"""Kauffman's bracket, the Jones polynomials of a knot and of the knot doubled, and Alexander polynomials.

The bracket (Kauffman, *Topology* 26, 1987) is contracted crossing by crossing: a state says how the edges that are cut
are paired so far, of which there are few if neighbouring crossings follow each other, and its value is a polynomial in
q = A².  Polynomials are packed in integers, their values at a large power of two, and so are Alexander's.

Equal types have equal invariants.  The converse fails for rare pairs, so that quick invariants, values at roots of
unity modulo a prime, catch accidents and prove nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...curve import Curve, check_closed
from .diagram import Diagram, Pass
from .projection import views

Laurent = Mapping[int, int]  # exponent to coefficient, which is not 0
_State = frozenset[tuple[int, int]]  # both ends of every open arc, each with the other one

_LOOP = {2: -1, -2: -1}  # −A² − A⁻²
MAX_CROSSINGS = 60  # a tenth of a second


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
    # from each crossing on, always the next one that most edges lead to; the start where fewest edges are cut at a time
    orders = []
    for start in range(0, max(len(code), 1), 1 + len(code) ** 2 // 10_000):
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
        orders.append((order, width))
    order, width = min(orders, key=lambda found: found[1])
    if width > 18:  # edges cut at a time, of which there are up to 4862 pairings; doubles of small knots have 12 to 14
        return None
    bits = 3 * len(code) + 2  # coefficients grow by 3 with a crossing: two smoothings, with up to two loops −q − 1/q
    states: dict[_State, int] = {frozenset(): 1}
    for a, b, c, d in order:
        # both smoothings of a crossing, A times one and 1/A times the other, and A⁵ times both: so powers of q are not
        # negative, whichever loops are closed
        after: dict[_State, int] = {}
        for power, arcs in ((3, ((a, b), (c, d))), (2, ((a, d), (b, c)))):
            for state, value in states.items():
                ends, closed = dict(state), 0
                for one, other in arcs:
                    if ends.get(one) == other:
                        del ends[one], ends[other]
                        closed += 1
                    elif one == other:
                        closed += 1
                    else:
                        first, last = ends.pop(one, one), ends.pop(other, other)
                        ends[first], ends[last] = last, first
                value <<= bits * (power - closed)
                for _ in range(closed):
                    value = -value - (value << 2 * bits)
                joined = frozenset(ends.items())
                after[joined] = after.get(joined, 0) + value
        states = after
    (value,) = states.values()  # the only one left, whose digits are coefficients
    found = {2 * k - 5 * len(code): digit for k, digit in enumerate(signed_digits(value, bits)) if digit}
    for _ in range(loops):
        found = times(found, _LOOP)
    return found


def times(a: Laurent, b: Laurent) -> dict[int, int]:
    """The product of two Laurent polynomials."""
    found: dict[int, int] = {}
    for (i, x), (j, y) in product(a.items(), b.items()):
        found[i + j] = found.get(i + j, 0) + x * y
    return {power: c for power, c in found.items() if c}


def signed_digits(value: int, bits: int) -> list[int]:
    """The digits of a whole number to a base of 2 to the power of ``bits``, from minus half of it on, lowest first."""
    found, half = list[int](), 1 << (bits - 1)
    while value:
        found.append(((value + half) & (2 * half - 1)) - half)
        value = (value - found[-1]) >> bits
    return found


def alexander(knot: Diagram) -> tuple[int, ...] | None:
    """Coefficients of the Alexander polynomial of a knot, positive at t = 1; None for too many crossings.

    They are digits of its value at a power of two, in which there is room for them: as rows of the matrix have at most
    the length √6 where |t| = 1, they are at most √6ⁿ⁻¹ (Hadamard).
    """
    if knot.crossings > MAX_CROSSINGS:
        return None
    if knot.crossings < 3:
        return (1,)
    bits = (6 ** (knot.crossings - 1)).bit_length() // 2 + 3
    prime = next((1 << k) - 1 for k in (127, 521, 1279, 2203, 4423, 9689) if k > bits * knot.crossings)  # Mersenne's
    value = alexander_value(knot, 1 << bits, prime)
    kept = np.trim_zeros(signed_digits(value - prime if 2 * value > prime else value, bits))
    return tuple(kept if sum(kept) > 0 else (-x for x in kept))


def alexander_value(knot: Diagram, t: int, prime: int) -> int:
    """The value of the Alexander polynomial of a knot, up to a unit ±tᵏ, modulo a prime.

    It is det(A), A the matrix of the arcs' relations at the crossings without a row and a column (Alexander, *Trans.
    AMS* 30, 1928): each says (1 − t) a + t b − c = 0 for the upper arc a and the lower ones b, c on its two sides.
    """
    count, arc, arcs = knot.crossings, 0, []
    for _, over in knot.sequence:
        arcs.append(arc)  # that on which the pass is, and that comes in below at a lower pass
        arc = (arc + (not over)) % count
    rows, sign = np.arange(count), np.array(knot.signs)
    lower, upper = np.array(arcs, dtype=np.intp)[np.array(knot.levels, dtype=np.intp)].T
    after = (lower + 1) % count
    matrix = np.zeros((count, count), dtype=np.int64 if prime < 1 << 31 else object)  # in which products fit
    matrix[rows, upper] += 1 - t
    matrix[rows, np.where(sign > 0, lower, after)] += t
    matrix[rows, np.where(sign > 0, after, lower)] -= 1
    matrix, found = matrix[:-1, :-1] % prime, 1
    for k in range(count - 1):  # only the few entries that change are touched
        row = k + int(np.argmax(matrix[k:, k] != 0))
        pivots = matrix[row].copy()
        matrix[row] = matrix[k]
        pivot = int(pivots[k])
        if not pivot:
            return 0
        found = found * (-pivot if row > k else pivot) % prime
        factors = matrix[:, k] * pow(pivot, -1, prime) % prime
        below, across = k + 1 + np.flatnonzero(factors[k + 1 :]), k + np.flatnonzero(pivots[k:])
        block = np.ix_(below, across)
        matrix[block] = (matrix[block] - np.outer(factors[below], pivots[across])) % prime
    return found


@dataclass(frozen=True)
class QuickInvariants:
    """What is quickly computed of a knot or link of any size."""

    # of each component the values at roots of unity of order 2, 3, 5 and 7 modulo a prime: of each, which is defined up
    # to units ±tᵏ, the smallest associate
    alexander: tuple[tuple[int, ...], ...]
    linking: tuple[int, ...]  # numbers of all pairs of components: of the first with the second, the third, …

    @property
    def is_trivial(self) -> bool:
        """Whether nothing here distinguishes the curve from separate round circles."""
        return not any(self.linking) and all(values == TRIVIAL for values in self.alexander)


def quick_invariants(curve: Curve) -> QuickInvariants:
    """Those of closed polygons in space; a CurveError if some are open, or touch themselves."""
    check_closed(curve, "knot types")
    diagram = next(views(curve, 12, clear=0.0))  # strands may be as near as doubles resolve: this is no proof
    parts = range(len(diagram.passes))
    return QuickInvariants(tuple(_values(diagram.restricted({k})) for k in parts), diagram.linking_numbers)


def linking_numbers(curve: Curve) -> tuple[int, ...]:
    """Linking numbers of all pairs of components of a link in space; a CurveError as `quick_invariants`."""
    check_closed(curve, "linking numbers")
    return next(views(curve, 12, clear=0.0)).linking_numbers


def unsigned_linking(link: Diagram) -> tuple[int, ...]:
    """Linking numbers without their signs, which orientations decide; sorted."""
    return tuple(sorted(map(abs, link.linking_numbers)))


def _values(knot: Diagram) -> tuple[int, ...]:
    """Values of the Alexander polynomial of one component."""
    prime, generator, values = 2_147_389_441, 11, []  # of the prime's units, whose number is a multiple of 2·3·5·7
    for q in (2, 3, 5, 7):
        root = pow(generator, (prime - 1) // q, prime)
        value = 1 if knot.crossings < 3 else alexander_value(knot, root, prime)
        associates = [value * pow(root, k, prime) for k in range(q)]
        values.append(min(x % prime for each in associates for x in (each, -each)))
    return tuple(values)


TRIVIAL = _values(Diagram(((),), ()))


def signature(knot: Diagram) -> int:
    """Signature of a knot, −2 for the right-handed trefoil (Gordon and Litherland, *Inventiones* 47, 1978).

    It is that of the Goeritz matrix of the white faces of a chessboard coloring, corrected by the crossings at which
    both strands run the same way along the black surface.
    """
    if not knot.crossings:
        return 0
    # faces on both sides of an edge have different colors
    color = {0: True}
    waiting = [0]
    while waiting:
        here = waiting.pop()
        for there in {knot.face_of[dart ^ 1] for dart in knot.faces[here]}.difference(color):
            color[there] = not color[here]
            waiting.append(there)
    white, count = [color[k] for k in range(len(knot.faces))], len(knot.faces)
    goeritz, correction = np.zeros((count, count)), 0
    for darts, sign in zip(knot.darts, knot.signs, strict=True):
        corners = [knot.face_of[dart] for dart in darts]  # lower right, upper right, upper left and lower left
        turn = 1 if white[corners[0]] else -1
        a, b = corners[::2] if turn > 0 else corners[1::2]
        correction += turn * (turn == sign)
        goeritz[[a, b], [a, b]] += turn
        goeritz[[a, b], [b, a]] -= turn
    kept = np.flatnonzero(white)[1:]
    eigenvalues = np.linalg.eigvalsh(goeritz[np.ix_(kept, kept)])  # none is 0: the determinant of a knot is odd
    return int(np.sign(eigenvalues).sum()) - correction
