"""Proved bounds of the Möbius energies of smooth knots and links, by ball arithmetic (docs/bounds.md has the proofs).

The energy of components γᵢ of period 1 is 4 for each, and ∬ f ds dt for each ordered pair of them, with

    f(s, t) = |γᵢ'(s)| |γⱼ'(t)| / |γᵢ(s) − γⱼ(t)|²,   less π² / sin² π(s − t) where i = j,

which is smooth, periodic, and for real t analytic in s where |Im s| ≤ a.  Its mean over nodes (k/n, (l + ½)/n), none of
which is on the diagonal, converges like e^{−2πan}.  That of π²/sin² is π² n, so nothing but 1/r² is summed up.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import permutations

from ..arguments import checked
from ..errors import CurveError, OptionError
from ..types import ComplexArray
from .balls import Loop, arb, coarsely, floor, precise, separations, squared_chords

_HEIGHTS = tuple(0.25 * 0.8**k for k in range(25))  # of strips, which are tried in turn
_SHARE = 1 / 3  # of the least separation and squared speed that is left on the edge of a good strip
_FINEST = 1e-12


@checked
def energy_bounds(coefficients: Sequence[ComplexArray], tolerance: float = 1e-8) -> tuple[float, float]:
    """Bounds of the Möbius energy of a smooth knot or link that are proved, and no further apart than ``tolerance``.

    ``coefficients`` has an array for each component, shape (modes + 1, 3), as in `FourierCurve`.  The last places of
    doubles come on top of the tolerance.  Raises CurveError where no bound is found because the curve meets itself or
    has a cusp, or nearly so, and OptionError for a tolerance below 1e-12.

    >>> import numpy as np
    >>> lower, upper = energy_bounds([np.array([[0, 0, 0], [1, -1j, 0]])])
    >>> lower <= 4 <= upper, upper - lower < 1e-8
    (True, True)
    """
    if not _FINEST <= tolerance < math.inf:
        raise OptionError(f"tolerance is {tolerance}; give a number from {_FINEST:g} on")
    with precise():
        loops = [Loop(c) for c in coefficients]
        pairs = [*((i, i) for i in range(len(loops))), *permutations(range(len(loops)), 2)]
        strips = [_strip(loops, i, j) for i, j in pairs]
        nodes = max((strip.nodes(tolerance / (2 * len(strips))) for strip in strips), default=1)
        value = sum((_mean(loops[i], loops[j], nodes) for i, j in pairs), len(loops) * (4 - nodes * arb.pi() ** 2))
        ball = value + arb(0, sum((strip.error(nodes) for strip in strips), arb(0)).upper())
        return math.nextafter(float(ball.lower()), -math.inf), math.nextafter(float(ball.upper()), math.inf)


@checked
def least_energy(crossings: int) -> float:
    """A lower bound of the energies of all knots of a type with such a crossing number c, rounded down: 4 + 2πc.

    M. Freedman, Z.-X. He and Z. Wang, *Möbius energy of knots and unknots*, Annals of Mathematics 139 (1994).
    """
    return math.nextafter(4.0 + 2.0 * math.pi * crossings, 0.0) if crossings else 4.0


@dataclass(frozen=True)
class _Strip:
    """Where |Im s| ≤ height, f is analytic in s for every real t, and |f| ≤ bound."""

    height: float
    bound: arb

    def error(self, nodes: int) -> arb:
        """Twice the error of the trapezoidal rule in s: once for s, and once for t in the pair the other way round."""
        return 4 * self.bound / (2 * arb.pi() * self.height * nodes).expm1()

    def nodes(self, error: float) -> int:
        """How many are enough."""
        return max(1, math.ceil(math.log1p(float(4 * self.bound) / error) / (2 * math.pi * self.height)))


def _strip(loops: Sequence[Loop], i: int, j: int) -> _Strip:
    """A strip about as high as can be; CurveError if none is found.

    Real parts are harmonic in s, so they are least on the edges of a strip, which are alike by conjugation: where those
    of q and γ₁'² are positive there, r² has no zeros but those of sin², and |γ₁'| is the root of what has none.
    """
    first, second = loops[i], loops[j]
    samples = first.speeds, partial(separations, first, second)
    degree = 2 * max(first.modes, second.modes)
    shares = [_SHARE * coarsely(partial(sample, 0.0)) for sample in samples]
    for height in _HEIGHTS:
        edges = [partial(sample, height) for sample in samples]
        if all(coarsely(edge) > share for edge, share in zip(edges, shares, strict=True)):
            speed, separation = (floor(edge, degree) for edge in edges)
            if speed is not None and separation is not None:
                bound = first.majorant(1, height) * second.majorant(1) / separation
                if first is second:
                    bound = (bound + arb.pi() ** 2) / (arb.pi() * height).sinh() ** 2
                return _Strip(height, bound)
    which = f"component {i + 1} meets itself or has a cusp" if i == j else f"components {i + 1} and {j + 1} meet"
    raise CurveError(f"{which}, or nearly so: no bound of the energy can be proved")


def _mean(first: Loop, second: Loop, nodes: int) -> arb:
    """The mean of |γ₁'| |γ₂'|/r² over nodes (k/n, (l + ½)/n)."""
    speeds = [[x.sqrt() for (x,) in loop.speeds(0.0, nodes, shift)] for shift, loop in enumerate((first, second))]
    total = arb(0)
    for v, row in zip(speeds[0], squared_chords(first.points(nodes), second.points(nodes, shift=1)), strict=True):
        total += v * sum((w / z.real for w, z in zip(speeds[1], row, strict=True)), arb(0))
    return total / nodes**2
