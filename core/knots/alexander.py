"""A quick signature of a knot type: values of the Alexander polynomial, and linking numbers.

Equal types have equal signatures.  The converse fails for rare pairs, so this catches accidents and proves nothing.
The polynomial is evaluated at roots of unity modulo a prime from the Wirtinger presentation of a projection; units
±tᵏ, up to which it is defined, are divided out by taking the smallest associate.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..curve import Curve, check_closed
from ..diagrams.crossings import plane_crossings
from ..types import BoolArray, FloatArray, IntArray

_PRIME = 2_147_482_681  # below 2³¹, so that products fit 64 bits; 1 more than a multiple of 2·3·5·7
_ORDERS = (2, 3, 5, 7)


@dataclass(frozen=True)
class Signature:
    """What can be told quickly of the type of a knot or link.

    Attributes
    ----------
    alexander
        For each component, the polynomial's values at roots of unity of order 2, 3, 5 and 7 modulo a prime.
    linking
        Linking numbers of all pairs of components.
    """

    alexander: tuple[tuple[int, ...], ...]
    linking: tuple[int, ...]

    @property
    def is_trivial(self) -> bool:
        """Whether nothing tells the curve from separate round circles."""
        return not any(self.linking) and all(values == TRIVIAL for values in self.alexander)


def signature(curve: Curve) -> Signature:
    """The signature of closed polygons in space, from a generic projection; a CurveError if some are open."""
    check_closed(curve, "knot types")
    crossings = _Crossings.of(curve)
    component = curve.mesh.component
    over, under = component[crossings.over], component[crossings.under]
    parts = range(len(curve.mesh.component_sizes))
    alexander = tuple(_values(crossings.within(over == k, under == k)) for k in parts)
    return Signature(alexander, _linking_numbers(curve, crossings))


def linking_numbers(curve: Curve) -> tuple[int, ...]:
    """Linking numbers of all pairs of components of a link in space; a CurveError if some are open."""
    check_closed(curve, "linking numbers")
    return _linking_numbers(curve, _Crossings.of(curve))


def _linking_numbers(curve: Curve, crossings: "_Crossings") -> tuple[int, ...]:
    component, count = curve.mesh.component, len(curve.mesh.component_sizes)
    over, under = component[crossings.over], component[crossings.under]
    return tuple(
        int(np.sum(crossings.sign[((over == a) & (under == b)) | ((over == b) & (under == a))])) // 2
        for a in range(count)
        for b in range(a + 1, count)
    )


@dataclass(frozen=True, eq=False)
class _Crossings:
    """Crossings of a projection: the edges that pass over and under, where on them, and the signs."""

    over: IntArray
    under: IntArray
    over_at: FloatArray
    under_at: FloatArray
    sign: IntArray

    @classmethod
    def of(cls, curve: Curve) -> "_Crossings":
        points = curve.vertices @ _generic_rotation()
        found = plane_crossings(curve.mesh, points)
        heights = [_height(curve, points, *end) for end in found.ends]
        above = heights[0] > heights[1]
        (i, s), (j, t) = found.ends
        over, under = np.where(above, i, j), np.where(above, j, i)
        over_at, under_at = np.where(above, s, t), np.where(above, t, s)
        return cls(over, under, over_at, under_at, np.sign(np.where(above, found.turn, -found.turn)).astype(np.intp))

    def within(self, over: BoolArray, under: BoolArray) -> "_Crossings":
        chosen = over & under
        at = (self.over_at[chosen], self.under_at[chosen])
        return _Crossings(self.over[chosen], self.under[chosen], *at, self.sign[chosen])


def _height(curve: Curve, points: FloatArray, edge: IntArray, at: FloatArray) -> FloatArray:
    """Third coordinates of points on edges."""
    start, end = points[curve.mesh.tails[edge], 2], points[curve.mesh.heads[edge], 2]
    return np.asarray(start + at * (end - start))


def _values(crossings: _Crossings) -> tuple[int, ...]:
    """Values of the Alexander polynomial of one component."""
    count = len(crossings.over)
    if count < 3:
        return TRIVIAL
    order = np.lexsort((crossings.under_at, crossings.under))
    ends = np.stack([crossings.under[order], crossings.under_at[order]])
    incoming = np.empty(count, dtype=np.intp)
    incoming[order] = np.arange(count)  # arc k ends at the k-th passage below
    outgoing = (incoming + 1) % count
    later = (ends[0][None, :] < crossings.over[:, None]) | (
        (ends[0][None, :] == crossings.over[:, None]) & (ends[1][None, :] < crossings.over_at[:, None])
    )
    above = np.count_nonzero(later, axis=1) % count
    return tuple(_value(q, above, incoming, outgoing, crossings.sign) for q in _ORDERS)


def _value(q: int, above: IntArray, incoming: IntArray, outgoing: IntArray, sign: IntArray) -> int:
    t = _root(q)
    count = len(above)
    matrix = np.zeros((count, count), dtype=np.int64)
    rows = np.arange(count)
    first, second = np.where(sign > 0, incoming, outgoing), np.where(sign > 0, outgoing, incoming)
    np.add.at(matrix, (rows, above), 1 - t)
    np.add.at(matrix, (rows, first), t)
    np.add.at(matrix, (rows, second), -1)
    return _smallest_associate(_determinant(matrix[:-1, :-1] % _PRIME), q)


def _determinant(matrix: IntArray) -> int:
    """Determinant modulo the prime, by elimination."""
    result = 1
    for k in range(len(matrix)):
        pivots = np.flatnonzero(matrix[k:, k])
        if not pivots.size:
            return 0
        row = k + int(pivots[0])
        if row != k:
            matrix[[k, row]] = matrix[[row, k]]
            result = -result
        pivot = int(matrix[k, k])
        result = result * pivot % _PRIME
        factors = matrix[k + 1 :, k] * pow(pivot, -1, _PRIME) % _PRIME
        below = k + 1 + np.flatnonzero(factors)
        matrix[below, k:] = (matrix[below, k:] - factors[below - k - 1, None] * matrix[k, k:] % _PRIME) % _PRIME
    return result % _PRIME


def _smallest_associate(value: int, q: int) -> int:
    return min(x for power in _powers(_root(q), q) for x in (value * power % _PRIME, -value * power % _PRIME))


def _powers(t: int, q: int) -> Iterator[int]:
    return (pow(t, k, _PRIME) for k in range(q))


def _root(q: int) -> int:
    """A root of unity of order q modulo the prime."""
    return next(r for g in range(2, 100) if (r := pow(g, (_PRIME - 1) // q, _PRIME)) != 1)


def _generic_rotation() -> FloatArray:
    """A rotation that no curve made by hand or on a lattice is special to."""
    q, _ = np.linalg.qr(np.random.default_rng(20211).normal(size=(3, 3)))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return np.asarray(q)


TRIVIAL = tuple(_smallest_associate(1, q) for q in _ORDERS)
