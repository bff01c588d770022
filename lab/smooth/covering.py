"""Cells of the torus of pairs (s, t), halved until each is proved to hold no pair of points of a smooth link that meet.

A component is γ(t) = Re Σₖ cₖ e^{2πikt}, 0 ≤ t < 1, with coefficients c, shape (modes + 1, 3), taken as exact: an
entire function of t, whose points are found to twice the digits of doubles by ball arithmetic.

Vectors in ℂ³ have ‖x + iy‖ = |x| + |y|, and numbers likewise, so that ‖zᵏ v‖ ≤ ‖z‖ᵏ |v| for real v.  Where
‖z − c‖ ≤ r around a real centre c, Taylor's formula gives ‖γ(z) − γ(c)‖ ≤ Σⱼ |γ⁽ʲ⁾(c)| rʲ/j! and a remainder.  Cells
are closed where such balls around γ(s) and γ(t) are apart, or such a ball around γ', of which (γ(s) − γ(t))/(s − t) is
a mean, does not reach 0.  All in doubles, with bounds on their errors; docs/bounds.md has the proofs.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from math import factorial

import numpy as np

from ...core.base import BoolArray, ComplexArray, CurveError, FloatArray, MobiusFlowError

try:
    from flint import acb as acb
    from flint import arb as arb
    from flint import ctx
except ImportError as error:
    raise MobiusFlowError('ball arithmetic needs python-flint: pip install python-flint (the extra "lab")') from error

precise = partial(ctx.workprec, 128)  # bits, more than cancellation here takes from those of two doubles
_DEPTH = 13  # of the smallest intervals, 2⁻¹³
_ORDERS = 14  # of derivatives in Taylor's formula
_SHARE = 0.9  # of a distance that balls may take
_NEAR = 6  # intervals from one to another, an even number, that the mean of γ' is taken over
_LEVELS = np.concatenate([[0], np.repeat(np.arange(_DEPTH + 1), 2 ** np.arange(_DEPTH + 1))])
_HALVES = 0.5 ** np.arange(1, _DEPTH + 2, dtype=np.float64)  # of the lengths of intervals, by level


def points(coefficients: ComplexArray, nodes: int, order: int = 0, shift: int = 0) -> tuple[FloatArray, FloatArray]:
    """A component's derivative at (j + shift/2)/nodes, and what these doubles leave; shapes (3, nodes).

    The error of both together is at most 2⁻¹⁰⁰ of the sum of all |(2πk)ʳ cₖ|, r the order.  It is a discrete Fourier
    transform, where frequencies are folded.
    """
    with precise():
        spectra = [[acb(0)] * nodes for _ in range(3)]
        for k, row in enumerate(coefficients):
            wave = acb(0, 2 * k * arb.pi()) ** order * acb(arb(k * shift) / nodes).exp_pi_i()
            for spectrum, x in zip(spectra, row, strict=True):
                spectrum[k % nodes] += (acb(complex(x)) * wave).conjugate()
        exact = [[z.real for z in acb.dft(spectrum)] for spectrum in spectra]
        high = [[float(x) for x in row] for row in exact]
        low = [[float(x - y) for x, y in zip(*rows, strict=True)] for rows in zip(exact, high, strict=True)]
    return np.array(high), np.array(low)


def scaled(coefficients: Sequence[ComplexArray]) -> tuple[list[ComplexArray], int]:
    """A link times a power of two, 2ᵖ, so that its largest coefficient is about 1; and p.  No square is far from 1.

    This is exact but for what is smaller by 2⁻¹⁰²², which is nothing beside rounding as it is bounded here.  Raises
    CurveError unless coefficients are finite and of shape (modes + 1, 3), and components of comparable sizes.
    """
    parts = [np.array(c, dtype=np.complex128, order="C") for c in coefficients]
    if not all(c.ndim == 2 and c.shape[1:] == (3,) and c.size and np.isfinite(c).all() for c in parts):
        raise CurveError("coefficients of a component must be finite numbers, of shape (modes + 1, 3)")
    doubles = [c.view(np.float64) for c in parts]
    sizes = [float(np.abs(each).max()) for each in doubles]
    power = -int(np.frexp(max(sizes, default=0.0))[1])
    for number, size in enumerate(sizes, start=1):
        # 2.0**-300 of the largest size: components whose squares, and those of distances, are far from 0
        if 0.0 < np.ldexp(size, power) < 2.0**-300:
            raise CurveError(f"component {number} is too small beside the largest for anything to be proved")
    return [np.ldexp(each, power).view(np.complex128) for each in doubles], power


@dataclass(frozen=True, eq=False)
class PolygonEdges:
    """How far a polygon with ``count`` vertices on a component is off: at its vertices, and in slope between them."""

    count: int
    off: float
    slope: float


@dataclass(frozen=True, eq=False)
class CurveArcs:
    """A component over the dyadic intervals: i has ((i − 2ˡ)/2ˡ, (i − 2ˡ + 1)/2ˡ), where 2ˡ ≤ i < 2ˡ⁺¹."""

    centers: FloatArray  # points at the middle of intervals; shape (2^(_DEPTH + 1), 3)
    sizes: FloatArray  # upper bounds on the norms of derivatives there, by order
    slack: FloatArray  # bounds on their rounding errors, by order
    norms: FloatArray  # |cₖ|, of the coefficients that are not 0
    frequencies: FloatArray  # 2πk of them
    edges: PolygonEdges | None = None  # of the polygon that the curve is moved to, if any

    @classmethod
    def of(cls, coefficients: ComplexArray) -> "CurveArcs":
        """The arcs of a component of a link that is `scaled`."""
        c = coefficients
        k, norms = np.arange(len(c)), np.linalg.norm(c, axis=1)
        powers = (2.0 * np.pi * k[:, None]) ** np.arange(_ORDERS + 1)
        turns = np.resize([1.0, 1j, -1.0, -1j], _ORDERS + 1)
        rows = (c[:, None, :] * (powers * turns)[:, :, None]).reshape(len(c), -1)
        angles, parts = 2 * np.arange(len(_LEVELS)) + 1 - 2 ** (_LEVELS + 1) << _DEPTH - _LEVELS, []
        for some in np.array_split(angles, 8):  # of intervals, which bound the memory
            waves = _circle()[np.outer(some, k) % len(_LEVELS)]
            parts.append(waves.real @ rows.real - waves.imag @ rows.imag)
        values = np.concatenate(parts).reshape(len(_LEVELS), _ORDERS + 1, 3)
        slack = 2.0**-51 * (len(c) + 20) * (norms @ powers)
        sizes, some = np.linalg.norm(values, axis=2) + slack, norms > 0.0
        return cls(values[:, 0], sizes, slack, norms[some], powers[some, 1])

    @property
    def height(self) -> float:
        """A bound on the height of strips where γ'² is proved to have no zero."""
        return float(np.min(self.sizes[1:, 1] / self.sizes[1:, 2]))

    def spread(self, order: int, reach: FloatArray) -> FloatArray:
        """Upper bounds of ‖F(z) − γ⁽ᵏ⁾(c)‖ where ‖z − c‖ ≤ ``reach``, by level; F is γ⁽ᵏ⁾ or that of the polygon."""
        rest = _ORDERS + 1 - order
        terms = np.cumprod(reach[:, None] / np.arange(1, rest), axis=1)
        with np.errstate(over="ignore"):
            x = np.outer(reach, self.frequencies)
            tail = (np.exp(x) * x**rest) @ (self.norms * self.frequencies**order) / factorial(rest)
        sums = np.einsum("ij,ij->i", self.sizes[:, order + 1 :], terms[_LEVELS])
        bound = sums + tail[_LEVELS] + 2.0 * self.slack[order]
        if self.edges is not None and order < 2:
            n = self.edges.count
            bend = self.sizes[:, 2] + self.spread(2, reach + 1.0 / n)
            bound += (bend / (8.0 * n**2) + self.edges.off, bend / (2.0 * n) + self.edges.slope)[order]
        return np.asarray(bound)

    def straight(self, height: float) -> BoolArray:
        """Where means of the derivative are not 0 as far as k intervals to either side; rows by k."""
        reaches = [(2 * k + 1) * _HALVES + height for k in range(_NEAR // 2 + 1)]
        return np.array([self.spread(1, reach) < _SHARE * self.sizes[:, 1] for reach in reaches])


@cache
def _circle() -> ComplexArray:
    """Points of the unit circle at equal steps, to the last bit."""
    with precise():
        return np.array([complex(acb(arb(2 * k) / len(_LEVELS)).exp_pi_i()) for k in range(len(_LEVELS))])


def cover(first: CurveArcs, second: CurveArcs, height: float = 0.0) -> float | None:
    """Prove that points γ₁(s) and γ₂(t) do not meet, where |Im s| ≤ height and t is real; None if that fails.

    Then (γ₁(s) − γ₂(t))² has no zero but at s = t, and (γ₁(s) − γ₂(t))²/(s − t)² none there, if both are the same
    component.  Returns an upper bound on ‖γ₁'(s)‖ |γ₂'(t)| / |(γ₁(s) − γ₂(t))²| except in cells around s = t, where
    it is at most 400/|s − t|².
    """
    radii = first.spread(0, _HALVES + height), second.spread(0, _HALVES)
    speeds = [arcs.sizes[:, 1] + arcs.spread(1, _HALVES + a) for arcs, a in ((first, height), (second, 0.0))]
    straight = first.straight(height) if first is second else None
    # 16: half a strip's height to intervals that are halved no further: it, not they, must be less
    finest = min(2**_DEPTH, 16 / height) if height else 2**_DEPTH
    i = j = np.ones(1, dtype=np.int64)
    largest = 0.0
    while len(i):
        distance = np.linalg.norm(first.centers[i] - second.centers[j], axis=1)
        rest = distance - radii[0][i] - radii[1][j]
        apart = rest > (1.0 - _SHARE) * distance
        ratios = speeds[0][i[apart]] * speeds[1][j[apart]] / rest[apart] ** 2
        largest = max(largest, np.max(ratios, initial=0.0))
        i, j = i[~apart], j[~apart]
        if straight is not None:
            # near the diagonal the mean of γ' from s to t must not be 0
            count = 1 << _LEVELS[i]
            steps = (j - i + count // 2) % count - count // 2
            near, middle = np.abs(steps) <= _NEAR, count + (i + steps // 2) % count
            left = ~np.asarray(near & straight[np.where(near, (np.abs(steps) + 1) // 2, 0), middle])
            i, j = i[left], j[left]
        if len(i) > 200_000 or np.any(i >= finest):  # open cells, far more than curves take
            return None
        i, j = (np.add.outer(2 * k, half).ravel() for k, half in ((i, [0, 0, 1, 1]), (j, [0, 1, 0, 1])))
    return float(largest)
