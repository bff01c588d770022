"""∬ ds dt/|D|² over two straight edges, D = Δ + (s − ½) e − (t − ½) f, with derivatives.

The integral along the second edge is in closed form (`moments`), the one along the first by graded panels.
Derivatives are those of the exact integral, at the same points.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..quadrature import gauss_legendre
from ..types import FloatArray, IntArray
from .edge_pairs import EdgePairs, Jet
from .moments import CONTACT, Moments, moments


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


_EXPONENT = 40.0  # convergence exponent of the panels: 5e-9 relative on the hardest pairs tried, gaps to 1e-7
_POINT_COUNTS = np.array([8, 12, 16, 24, 32, 48, 64, 96, 128])
_REACH = 0.7  # singularities further away than this many edge lengths get no panel of their own


def graded_points(pairs: EdgePairs) -> Iterator[tuple[IntArray, FloatArray, FloatArray]]:
    """Points on the first edges: (pair, s, weight), shapes (panels,), (panels, points) and (panels, points).

    s ∈ [0, 1] is the parameter along the edge; every pair's weights add up to 1.
    """
    position, distance = _near_singularities(pairs)
    breaks = np.sort(np.clip(np.where(distance < _REACH, position, 0.0), 0.0, 1.0), axis=1)
    breaks = np.pad(breaks, ((0, 0), (1, 1)), constant_values=((0.0, 0.0), (0.0, 1.0)))
    delta = np.min(np.hypot(distance[:, None, :], position[:, None, :] - breaks[:, :, None]), axis=2)

    # every interval between breaks is halved, each half graded towards its end
    half = 0.5 * np.diff(breaks, axis=1)
    start = np.concatenate([breaks[:, :-1], breaks[:, 1:]], axis=1)
    signed_half = np.concatenate([half, -half], axis=1)
    width = np.maximum(np.concatenate([delta[:, :-1], delta[:, 1:]], axis=1), CONTACT)
    pair, panel = np.nonzero(signed_half)
    start, signed_half, width = start[pair, panel], signed_half[pair, panel], width[pair, panel]
    reach = np.arcsinh(np.abs(signed_half) / width)
    points = _point_count(reach)
    for n in np.unique(points):
        chosen = points == n
        u, weight = gauss_legendre(int(n))
        u = reach[chosen, None] * u
        scale = np.copysign(width[chosen], signed_half[chosen])[:, None]
        s = start[chosen, None] + scale * np.sinh(u)
        yield pair[chosen], s, np.abs(scale) * np.cosh(u) * (reach[chosen, None] * weight)


def _near_singularities(pairs: EdgePairs) -> tuple[FloatArray, FloatArray]:
    """Complex singularities s ± iδ of the outer integrand, as s and δ, shapes (k, 3).

    They sit where the complexified distance to an end point of the second edge vanishes, and at the lines'
    closest approach if its foot lies within the second edge (otherwise the poles pass by: δ = inf).
    """
    e, f = pairs.e, pairs.f
    e2, f2 = _dot(e, e), _dot(f, f)
    length = np.sqrt(e2)

    def foot(from_x0: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        s = _dot(from_x0, e) / e2
        height = from_x0 - s[:, None] * e
        return s, height, np.linalg.norm(height, axis=1) / length

    s0, g0, delta0 = foot(pairs.combination((-1.0, 0.5, -0.5)))  # the second edge's tail
    s1, _, delta1 = foot(pairs.combination((-1.0, 0.5, 0.5)))  # its head
    # its point y0 + t f has the distance |g0 + t g1| from the line of e, smallest at t
    g1 = f - (_dot(f, e) / e2)[:, None] * e
    g1_square = _dot(g1, g1)
    crossing = g1_square > 1e-24 * f2
    t = -_dot(g0, g1) / np.where(crossing, g1_square, 1.0)
    crossing &= (t > 0.0) & (t < 1.0)
    s = s0 + t * (s1 - s0)
    delta = np.where(crossing, np.linalg.norm(g0 + t[:, None] * g1, axis=1) / length, np.inf)
    return np.stack([np.where(crossing, s, 0.0), s0, s1], axis=1), np.stack([delta, delta0, delta1], axis=1)


def _point_count(reach: FloatArray) -> IntArray:
    """Gauss points for a panel u in [0, reach] whose nearest singularity is iπ/2 (Bernstein ellipse)."""
    z = -1.0 + 1j * np.pi / reach
    root = np.sqrt(z * z - 1.0)
    rho = np.maximum(np.abs(z + root), np.abs(z - root))
    needed = np.ceil(_EXPONENT / (2.0 * np.log(rho)))
    index = np.minimum(np.searchsorted(_POINT_COUNTS, needed), len(_POINT_COUNTS) - 1)
    return np.asarray(_POINT_COUNTS[index])


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", a, b))
