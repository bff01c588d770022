"""∬ ds dt/|D|² over two straight edges, D = Δ + (s − ½) e − (t − ½) f, with derivatives.

The integral along the second edge is in closed form (`moments`), the one along the first by graded panels.
Derivatives are those of the exact integral, at the same points.
"""

from typing import NamedTuple

import numpy as np

from ..types import FloatArray, IntArray
from .edge_pairs import EdgePairs
from .graded import graded_points
from .jets import Jet
from .moments import Moments, moments


def inverse_square(pairs: EdgePairs) -> Jet:
    """The integral as a jet in (Δ, e, f); edges must not touch."""
    k, m = pairs.delta.shape
    curved = pairs.directions.shape[2] > 0
    value, first, second = np.zeros(k), np.zeros((k, 3, m)), np.zeros((k if curved else 0, 3, m, 3, m))
    length = np.linalg.norm(pairs.f, axis=1)
    tau = pairs.f / length[:, None]
    for pair, s, weight in graded_points(pairs):
        inner = _Inner.at(pairs, tau, length, pair, s, curved)
        weight = weight / length[pair, None]  # dt from dw
        np.add.at(value, pair, np.sum(weight * inner.moments.inverse, axis=1))
        np.add.at(first, pair, _first(inner, s - 0.5, weight))
        if curved:
            np.add.at(second, pair, _second(inner, s - 0.5, weight))
    slopes = first.reshape(k, 3 * m)
    change = second.reshape(-1, 3 * m, 3 * m) @ pairs.directions if curved else pairs.directions
    return Jet(value, slopes, pairs.along(slopes), change)


class _Inner(NamedTuple):
    """The second edges seen from points of the first ones: D = height − w τ, and t − ½ = (w + foot)/length."""

    height: FloatArray  # (panels, points, m)
    foot: FloatArray  # (panels, points)
    tau: FloatArray  # (panels, m)
    length: FloatArray  # (panels, 1)
    moments: Moments

    @classmethod
    def at(
        cls, pairs: EdgePairs, tau: FloatArray, length: FloatArray, pair: IntArray, s: FloatArray, cubes: bool
    ) -> "_Inner":
        z = pairs.delta[pair, None, :] + (s - 0.5)[:, :, None] * pairs.e[pair, None, :]
        along, width = tau[pair], length[pair, None]
        foot = np.einsum("psm,pm->ps", z, along)
        height = z - foot[:, :, None] * along[:, None, :]
        h2 = np.einsum("psm,psm->ps", height, height)
        return cls(height, foot, along, width, moments(h2, -0.5 * width - foot, 0.5 * width - foot, cubes))

    def powers(self, lowest: FloatArray, next_: FloatArray) -> FloatArray:
        """∫ (t − ½) g from ∫ g and ∫ w g."""
        return (next_ + self.foot * lowest) / self.length


def _first(inner: _Inner, s: FloatArray, weight: FloatArray) -> FloatArray:
    """Derivatives by (Δ, e, f), shape (panels, 3, m): ∇ 1/|D|² = −2 D/|D|⁴ times (1, s − ½, ½ − t)."""
    m0, m1, m2 = inner.moments.square
    n0, n1 = inner.powers(m0, m1), inner.powers(m1, m2)
    result = np.empty((len(weight), 3, inner.tau.shape[1]))
    for block, (along_height, along_tau, factor) in enumerate(
        ((m0, m1, weight), (m0, m1, weight * s), (n0, n1, -weight))
    ):
        result[:, block] = -2.0 * np.einsum("ps,psm->pm", factor * along_height, inner.height)
        result[:, block] += 2.0 * np.sum(factor * along_tau, axis=1)[:, None] * inner.tau
    return result


def _second(inner: _Inner, s: FloatArray, weight: FloatArray) -> FloatArray:
    """Second derivatives by (Δ, e, f), shape (panels, 3, m, 3, m): those of 1/|D|² are 8 D Dᵀ/|D|⁶ − 2/|D|⁴."""
    m0, m1, m2 = inner.moments.square
    c0, c1, c2, c3, c4 = inner.moments.cube
    n0, n1 = inner.powers(m0, m1), inner.powers(m1, m2)
    # ∫ (t − ½)ʲ wᵏ/|D|⁶ for j = 0, 1, 2 (outer) and k = 0, 1, 2
    zeroth = (c0, c1, c2)
    first = tuple(inner.powers(lower, higher) for lower, higher in ((c0, c1), (c1, c2), (c2, c3)))
    third = inner.powers(c3, c4)
    second = tuple(inner.powers(*pair) for pair in ((first[0], first[1]), (first[1], first[2]), (first[2], third)))
    forms = ((m0, zeroth), (n0, first), (inner.powers(n0, n1), second))
    m = inner.tau.shape[1]
    result = np.empty((len(weight), 3, m, 3, m))
    for row, column, factor, power in (
        (0, 0, weight, 0),
        (0, 1, weight * s, 0),
        (1, 1, weight * s * s, 0),
        (0, 2, -weight, 1),
        (1, 2, -weight * s, 1),
        (2, 2, weight, 2),
    ):
        block = _form(inner, factor, *forms[power])
        result[:, row, :, column, :] = block
        result[:, column, :, row, :] = block
    return result


def _form(inner: _Inner, factor: FloatArray, square: FloatArray, cube: tuple[FloatArray, ...]) -> FloatArray:
    """Σ factor (8 D Dᵀ/|D|⁶ − 2/|D|⁴) over the points, D = height − w τ; shape (panels, m, m)."""
    height, tau = inner.height, inner.tau
    c0, c1, c2 = (8.0 * factor * c for c in cube)
    block = np.asarray((c0[:, :, None] * height).transpose(0, 2, 1) @ height)
    mixed = np.einsum("ps,psm->pm", c1, height)[:, :, None] * tau[:, None, :]
    block -= mixed + mixed.transpose(0, 2, 1)
    block += np.sum(c2, axis=1)[:, None, None] * (tau[:, :, None] * tau[:, None, :])
    block -= 2.0 * np.sum(factor * square, axis=1)[:, None, None] * np.eye(tau.shape[1])
    return block
