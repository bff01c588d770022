"""Cells of the torus of pairs (s, t), halved until each is proved to hold no pair of points of a smooth link that meet.

Vectors in ℂ³ have ‖x + iy‖ = |x| + |y|, and numbers likewise, so that ‖zᵏ v‖ ≤ ‖z‖ᵏ |v| for real v.  Where
‖z − c‖ ≤ r around a real centre c, Taylor's formula gives ‖γ(z) − γ(c)‖ ≤ Σⱼ |γ⁽ʲ⁾(c)| rʲ/j! and a remainder.  Cells
are closed where such balls around γ(s) and γ(t) are apart, or such a ball around γ', of which (γ(s) − γ(t))/(s − t) is
a mean, does not reach 0.  All in doubles, with bounds on their errors; docs/bounds.md has the proofs.
"""

from dataclasses import dataclass
from functools import cache
from math import factorial

import numpy as np

from ..errors import CurveError
from ..types import BoolArray, ComplexArray, FloatArray, IntArray
from .balls import acb, arb, precise

_DEPTH = 13  # of the smallest intervals, 2⁻¹³
_ORDERS = 14  # of derivatives in Taylor's formula
_SHARE = 0.9  # of a distance that balls may take
_NEAR = 6  # intervals from one to another, an even number, that the mean of γ' is taken over
_FLATTEST = 16  # half a strip's height to intervals that are halved no further: it, not they, must be less
_MOST = 200_000  # open cells, far more than curves take
_LARGEST = 1e100  # coefficients, whose products with powers of frequencies have squares
_BLOCKS = 8  # of intervals, which bound the memory
_LEVELS = np.concatenate([[0], np.repeat(np.arange(_DEPTH + 1), 2 ** np.arange(_DEPTH + 1))])
_HALVES = 0.5 ** (np.arange(_DEPTH + 1) + 1)  # of the lengths of intervals, by level


@dataclass(frozen=True, eq=False)
class Edges:
    """How far a polygon with ``count`` vertices on a component is off: at its vertices, and in slope between them."""

    count: int
    off: float
    slope: float


@dataclass(frozen=True, eq=False)
class Arcs:
    """A component over the dyadic intervals: i has ((i − 2ˡ)/2ˡ, (i − 2ˡ + 1)/2ˡ), where 2ˡ ≤ i < 2ˡ⁺¹."""

    centers: FloatArray  # points at the middle of intervals; shape (2^(_DEPTH + 1), 3)
    sizes: FloatArray  # upper bounds on the norms of derivatives there, by order
    slack: FloatArray  # bounds on their rounding errors, by order
    norms: FloatArray  # |cₖ|, of the coefficients that are not 0
    frequencies: FloatArray  # 2πk of them
    edges: Edges | None = None  # of the polygon that the curve is moved to, if any

    @classmethod
    def of(cls, coefficients: ComplexArray) -> "Arcs":
        """The arcs of a component; CurveError unless coefficients have shape (modes + 1, 3) and are not too large."""
        c = np.asarray(coefficients, dtype=np.complex128)
        if c.ndim != 2 or c.shape[1:] != (3,) or not c.size or not (np.abs(c) < _LARGEST).all():
            raise CurveError(f"coefficients of a component must be below {_LARGEST:g}, of shape (modes + 1, 3)")
        k, norms = np.arange(len(c)), np.linalg.norm(c, axis=1)
        powers = (2.0 * np.pi * k[:, None]) ** np.arange(_ORDERS + 1)
        turns = np.resize([1.0, 1j, -1.0, -1j], _ORDERS + 1)
        rows = (c[:, None, :] * (powers * turns)[:, :, None]).reshape(len(c), -1)
        angles, parts = 2 * np.arange(len(_LEVELS)) + 1 - 2 ** (_LEVELS + 1) << _DEPTH - _LEVELS, []
        for some in np.array_split(angles, _BLOCKS):
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


def cover(first: Arcs, second: Arcs, height: float = 0.0) -> float | None:
    """Prove that points γ₁(s) and γ₂(t) do not meet, where |Im s| ≤ height and t is real; None if that fails.

    Then (γ₁(s) − γ₂(t))² has no zero but at s = t, and (γ₁(s) − γ₂(t))²/(s − t)² none there, if both are the same
    component.  Returns an upper bound on ‖γ₁'(s)‖ |γ₂'(t)| / |(γ₁(s) − γ₂(t))²| except in cells around s = t, where
    it is at most 400/|s − t|².
    """
    radii = first.spread(0, _HALVES + height), second.spread(0, _HALVES)
    speeds = [arcs.sizes[:, 1] + arcs.spread(1, _HALVES + a) for arcs, a in ((first, height), (second, 0.0))]
    straight = first.straight(height) if first is second else None
    finest = min(2**_DEPTH, _FLATTEST / height) if height else 2**_DEPTH
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
            left = ~_along(i, j, straight)
            i, j = i[left], j[left]
        if len(i) > _MOST or np.any(i >= finest):
            return None
        i, j = (np.add.outer(2 * k, half).ravel() for k, half in ((i, [0, 0, 1, 1]), (j, [0, 1, 0, 1])))
    return float(largest)


def _along(i: IntArray, j: IntArray, straight: BoolArray) -> BoolArray:
    """Which cells, all of one size, are near the diagonal and have means of γ' from s to t that are not 0."""
    count = 1 << _LEVELS[i]
    steps = (j - i + count // 2) % count - count // 2
    near, middle = np.abs(steps) <= _NEAR, count + (i + steps // 2) % count
    return np.asarray(near & straight[np.where(near, (np.abs(steps) + 1) // 2, 0), middle])
