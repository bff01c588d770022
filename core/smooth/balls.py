"""Smooth closed curves in ball arithmetic, and lower bounds of trigonometric polynomials that are proved.

A component is γ(t) = Re Σₖ cₖ e^{2πikt}, 0 ≤ t < 1, with coefficients c, shape (modes + 1, 3), taken for exactly what
they are: an entire function of t.  Where a vector v is complex, v² is v·v without conjugation.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from itertools import chain

import numpy as np
from scipy.fft import next_fast_len

from ..errors import CurveError, MobiusFlowError
from ..types import ComplexArray

try:
    from flint import acb as acb
    from flint import acb_mat as acb_mat
    from flint import arb as arb
    from flint import ctx
except ImportError as error:
    raise MobiusFlowError('ball arithmetic needs python-flint: pip install python-flint (the extra "atlas")') from error

_PRECISION = 128  # bits, more than cancellation here takes from those of a double
_MOST = 2_000  # nodes in each variable: two seconds
_COARSE = 128
_BLOCK = 64  # rows of a matrix at once, which bounds the memory
Sample = Callable[[int], Iterable[Sequence[arb]]]  # rows of values at equally spaced nodes, so many in each variable


def precise() -> AbstractContextManager[None]:
    """Compute with balls of enough digits."""
    return ctx.workprec(_PRECISION)


class Loop:
    """A component of a smooth knot or link."""

    def __init__(self, coefficients: ComplexArray) -> None:
        given = np.asarray(coefficients, dtype=np.complex128)
        if given.ndim != 2 or given.shape[1:] != (3,) or not given.size or not np.isfinite(given).all():
            raise CurveError("coefficients of a component must be finite, of shape (modes + 1, 3)")
        exact = [[acb(complex(x)) for x in row] for row in given]
        self.modes = len(exact) - 1
        self._rows = {0: [acb(x.real) for x in exact[0]]}  # of e^{2πikt} by k
        for k, row in enumerate(exact[1:], 1):
            self._rows[k], self._rows[-k] = [x / 2 for x in row], [x.conjugate() / 2 for x in row]
        self._squares = [(sum((abs(x) ** 2 for x in row), arb(0)), abs(_square(row))) for row in exact]

    def points(self, nodes: int, height: float = 0.0, order: int = 0, shift: int = 0) -> acb_mat:
        """Values of a derivative at (j + shift/2)/nodes + i·height, shape (nodes, 3)."""
        circle = [acb(arb(j) / nodes).exp_pi_i() for j in range(2 * nodes)]
        waves = [[circle[k * (2 * j + shift) % (2 * nodes)] for k in self._rows] for j in range(nodes)]
        rows = []
        for k, row in self._rows.items():
            factor = acb(0, 2 * k * arb.pi()) ** order * (-2 * k * arb.pi() * height).exp()
            rows.append([x * factor for x in row])
        return acb_mat(waves) * acb_mat(rows)

    def majorant(self, order: int, height: float = 0.0) -> arb:
        """An upper bound of the norm of a derivative, 1 or higher, where |Im t| ≤ height: the sum over modes."""
        total = arb(0)
        for k, (norm, square) in enumerate(self._squares):
            w = 2 * k * arb.pi()
            total += w**order * ((norm * (2 * w * height).cosh() + square) / 2).sqrt()
        return total

    def speeds(self, height: float, nodes: int, shift: int = 0) -> Iterator[Sequence[arb]]:
        """Rows, with one number each, of Re γ'² at (j + shift/2)/nodes + i·height; of degree 2·modes."""
        return ([_square(row).real] for row in self.points(nodes, height, 1, shift).tolist())


def _square(vector: Sequence[acb]) -> acb:
    return sum((x * x for x in vector), acb(0))


def squared_chords(first: acb_mat, second: acb_mat) -> Iterator[list[acb]]:
    """Rows of (xⱼ − yₖ)² for points x and y, shapes (n, 3) and (m, 3)."""
    left = [[_square(row), acb(1), *(-2 * x for x in row)] for row in first.tolist()]
    right = acb_mat([[acb(1), _square(row), *row] for row in second.tolist()]).transpose()
    for start in range(0, len(left), _BLOCK):
        yield from (acb_mat(left[start : start + _BLOCK]) * right).tolist()


def separations(first: Loop, second: Loop, height: float, nodes: int) -> Iterator[Sequence[arb]]:
    """Rows of Re q at s = j/nodes + i·height, for t = (k + ½)/nodes; of degree 2·modes or less in both.

    q = (γ₁(s) − γ₂(t))², divided by sin² π(s − t) where both are the same component.
    """
    chords = squared_chords(first.points(nodes, height), second.points(nodes, shift=1))
    if first is not second:
        return ([z.real for z in row] for row in chords)
    differences = [acb(-(2 * arb(k) + 1) / (2 * nodes), height) for k in range(nodes)]
    weights = [1 / z.sin_pi() ** 2 for z in differences] * 2  # by k − j, of period nodes
    return (
        [(z * w).real for z, w in zip(row, weights[nodes - j : 2 * nodes - j], strict=True)]
        for j, row in enumerate(chords)
    )


def floor(sample: Sample, degree: int) -> arb | None:
    """A positive lower bound of a trigonometric polynomial f of period 1 in one or two variables, or None.

    In a cell of the mesh f is at least what it is at some corner, less (sup |f_ss| + sup |f_tt|)/(8 nodes²), by which
    it may differ from the bilinear interpolant.  Sums over the Fourier coefficients of f, which are those of its values
    at more nodes than twice the degree, bound these derivatives.  The mesh is fine enough for a quarter of the least.
    """
    nodes = next_fast_len(2 * degree + 1)
    rows = list(sample(nodes))
    bend, least = _bend(rows), _least(rows)
    while least > 0.0:
        nodes = max(nodes, math.ceil(min(math.sqrt(float(bend) / (4.0 * least)), _MOST + 1.0)))
        if nodes > _MOST:
            return None
        least = _least(sample(nodes))
        bound: arb = least - bend / (8 * nodes**2)
        if bound > least / 4.0:
            return bound.lower()
    return None


def coarsely(sample: Sample) -> float:
    """About the least value, of which nothing is proved."""
    return min(map(float, chain.from_iterable(sample(_COARSE))))


def _least(rows: Iterable[Sequence[arb]]) -> float:
    """A lower bound of all entries, hardly below the least; 0 if that is not positive."""
    least = math.inf
    for row in rows:
        bound = min(map(float, row)) * (1.0 - 2.0**-30)
        if not (bound > 0.0 and all(x > bound for x in row)):
            return 0.0
        least = min(least, bound)
    return least


def _bend(rows: Sequence[Sequence[arb]]) -> arb:
    """An upper bound of sup |f_ss| + sup |f_tt| from values at nodes, rows for s and columns for t."""
    spectrum = [acb.dft(list(column)) for column in zip(*(acb.dft(list(row)) for row in rows), strict=True)]
    along, across = ([(2 * min(k, n - k) * arb.pi()) ** 2 for k in range(n)] for n in (len(rows), len(spectrum)))
    total = arb(0)
    for u, line in zip(across, spectrum, strict=True):
        total += sum((abs(z) * (u + v) for v, z in zip(along, line, strict=True)), arb(0))
    return total / (len(rows) * len(spectrum))
