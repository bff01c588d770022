"""Proved bounds on the Möbius energies of smooth knots and links (docs/bounds.md has the proofs).

The energy of components γᵢ of period 1 is 4 for each, and ∬ f ds dt for each ordered pair of them, with

    f(s, t) = |γᵢ'(s)| |γⱼ'(t)| / |γᵢ(s) − γⱼ(t)|²,   less π² / sin² π(s − t) where i = j,

which is smooth, periodic, and for real t analytic in s where |Im s| ≤ a.  Its mean over nodes (k/n, (l + ½)/n), none of
which is on the diagonal, converges like e^{−2πan}.  That of π²/sin² is π² n, so only 1/r² is summed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from ...core.base import ComplexArray, CurveError, OptionError, checked
from .covering import CurveArcs, arb, cover, points, precise, scaled


@checked
def energy_bounds(coefficients: Sequence[ComplexArray], tolerance: float = 1e-8) -> tuple[float, float]:
    """Proved bounds on the Möbius energy of a smooth knot or link, no further apart than ``tolerance``.

    ``coefficients`` has an array for each component, shape (modes + 1, 3), as in `FourierCurve`.  Rounding comes on top
    of the tolerance, 1e-8 at most.  Raises CurveError where no bound is found because the curve meets itself or has a
    cusp, or nearly so, and OptionError for a tolerance below 1e-10.

    >>> import numpy as np
    >>> lower, upper = energy_bounds([np.array([[0, 0, 0], [1, -1j, 0]])])
    >>> lower <= 4 <= upper, upper - lower < 1e-8
    (True, True)
    """
    if not 1e-10 <= tolerance < math.inf:
        raise OptionError(f"tolerance is {tolerance}; give a number from 1e-10 on")
    coefficients, _ = scaled(coefficients)
    with precise():
        arcs = [CurveArcs.of(c) for c in coefficients]
        strips = {(i, i): _strip(arcs, i, i) for i in range(len(arcs))}
        for i, j in permutations(range(len(arcs)), 2):
            strips[i, j] = _strip(arcs, i, j, strips[i, i].height)
        nodes = max((strip.nodes(tolerance / (2 * len(strips))) for strip in strips.values()), default=1)
        ball = len(arcs) * (4 - nodes * arb.pi() ** 2)
        for (i, j), strip in strips.items():
            ball += _mean(coefficients[i], coefficients[j], nodes) + arb(0, strip.error(nodes).upper())
        return math.nextafter(float(ball.lower()), -math.inf), math.nextafter(float(ball.upper()), math.inf)


@dataclass(frozen=True)
class _Strip:
    """Where |Im s| ≤ height, f is analytic in s for every real t, and |f| ≤ bound."""

    height: float
    bound: arb

    def error(self, nodes: int) -> arb:
        """Twice the error of the trapezoidal rule in s: once for s, and once for t in the pair in reverse."""
        return 4 * self.bound / (2 * arb.pi() * self.height * nodes).expm1()

    def nodes(self, error: float) -> int:
        """How many nodes are enough for an error."""
        return max(1, math.ceil(math.log1p(float(4 * self.bound) / error) / (2 * math.pi * self.height)))


def _strip(arcs: Sequence[CurveArcs], i: int, j: int, highest: float = math.inf) -> _Strip:
    """A strip about as high as can be, but no higher than ``highest``; CurveError if none is found."""
    if cover(arcs[i], arcs[j]) is not None:
        height = min(highest, arcs[i].height)
        while height >= 1.5e-4:  # lower strips would take too many nodes
            ratio = cover(arcs[i], arcs[j], height)
            if ratio is not None:
                bound = 1.0001 * arb(ratio)
                if i == j:
                    bound = bound.max(400 / arb(height) ** 2) + (arb.pi() / (arb.pi() * height).sinh()) ** 2
                return _Strip(height, bound)
            height *= 0.85
    which = f"component {i + 1} meets itself or has a cusp" if i == j else f"components {i + 1} and {j + 1} meet"
    raise CurveError(f"{which}, or nearly so: no bound of the energy can be proved")


def _mean(first: ComplexArray, second: ComplexArray, nodes: int) -> arb:
    """The mean of |γ₁'| |γ₂'|/r² over nodes (k/n, (l + ½)/n).

    Points are sums of two doubles, so that differences lose no digits, and all terms are positive.
    """
    (x, low_x), (y, low_y) = points(first, nodes), points(second, nodes, shift=1)
    v, w = (np.linalg.norm(points(c, nodes, 1, shift)[0], axis=0) for shift, c in enumerate((first, second)))
    terms_at_once = 64  # are added in doubles before the sums are added exactly
    sums, nearest, rows = [], math.inf, max(1, (1 << 18) // nodes)  # pairs of nodes at once
    for k in range(0, nodes, rows):
        some = slice(k, k + rows)
        square = np.zeros((len(v[some]), nodes))
        for a in range(3):
            square += (np.subtract.outer(x[a, some], y[a]) + np.subtract.outer(low_x[a, some], low_y[a])) ** 2
        terms = np.multiply.outer(v[some], w) / square
        sums.append(math.fsum(np.add.reduceat(terms, range(0, nodes, terms_at_once), axis=1).ravel().tolist()))
        nearest = min(nearest, square.min())
    coordinates = max(np.abs(c).sum() for c in (first, second))
    error = (terms_at_once + 32) * 2.0**-53 + 2.0**-98 * coordinates / math.sqrt(nearest)
    return arb(math.fsum(sums)) * arb(1, error) / nodes**2
