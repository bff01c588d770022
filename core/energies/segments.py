"""The Möbius energy of two straight edges, ∬ F over both, however near they are.

With F = (1 − cos α)/r² the cosine part is elementary, a logarithm of the cross ratio of the four end
points, and only V = ∬ 1/r² needs work.  For a point x of the first edge the integral over the second is
elementary (`_inner_moments`).  The remaining integrand is analytic but nearly singular where x comes near
the second edge: at the lines' closest approach and at the feet of the second edge's end points.  Each of
these becomes the end of a panel graded by s = s₀ + δ sinh u, δ the distance of the complex singularity,
which makes Gauss–Legendre points converge geometrically at a rate that depends on log δ only.
"""

from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..types import FloatArray, IntArray, frozen

_DIGITS = 40.0  # convergence exponent of the panels: 5e-9 relative on the hardest pairs tried, gaps to 1e-7
_POINT_COUNTS = np.array([6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96, 128])


class EdgePairs(NamedTuple):
    """End points of k pairs of edges, each array (k, m): edge x from x0 to x1, edge y from y0 to y1."""

    x0: FloatArray
    x1: FloatArray
    y0: FloatArray
    y1: FloatArray


def exact_contributions(pairs: EdgePairs) -> tuple[FloatArray, EdgePairs]:
    """Integrate F over both edges of every pair.

    Returns the values, shape (k,), and their derivatives with respect to the end points.  Relative error
    of the values at most 1e-8; edges must not touch.
    """
    value, derivative = _inverse_square(pairs)
    log_value, log_derivative = _log_cross_ratio(pairs)
    return value - log_value, EdgePairs(*(d - ld for d, ld in zip(derivative, log_derivative, strict=True)))


def _log_cross_ratio(pairs: EdgePairs) -> tuple[FloatArray, EdgePairs]:
    """∬ cos α / r² = log(|x1−y1| |x0−y0| / (|x1−y0| |x0−y1|)), and its derivative."""
    x0, x1, y0, y1 = pairs

    def half_log_square(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        d = x - y
        square = np.einsum("ij,ij->i", d, d)
        return 0.5 * np.log(square), d / square[:, None]

    (v11, d11), (v00, d00) = half_log_square(x1, y1), half_log_square(x0, y0)
    (v10, d10), (v01, d01) = half_log_square(x1, y0), half_log_square(x0, y1)
    return v11 + v00 - v10 - v01, EdgePairs(d00 - d01, d11 - d10, d10 - d00, d01 - d11)


def _inverse_square(pairs: EdgePairs) -> tuple[FloatArray, EdgePairs]:
    """V = ∬ 1/r² and its derivative."""
    count, dimension = pairs.x0.shape
    e, f = pairs.x1 - pairs.x0, pairs.y1 - pairs.y0
    length_e, length_f = np.linalg.norm(e, axis=1), np.linalg.norm(f, axis=1)
    tau = f / length_f[:, None]
    from_y0 = pairs.x0 - pairs.y0

    value = np.zeros(count)
    by_x0, by_x1, by_y1 = (np.zeros((count, dimension)) for _ in range(3))
    for pair, s, weight in _graded_points(pairs):
        # x(s) − y0 for all points of the panels, shape (panels, points, m)
        z = from_y0[pair, None, :] + s[:, :, None] * e[pair, None, :]
        i0, d0, d1 = _inner_moments(z, tau[pair], length_f[pair])
        weight = weight * length_e[pair, None]
        np.add.at(value, pair, np.sum(weight * i0, axis=1))
        # ∇_x 1/r² = −2 D/r⁴, and the same with the other sign for y
        np.add.at(by_x1, pair, -2.0 * np.einsum("ps,psm->pm", weight * s, d0))
        np.add.at(by_x0, pair, -2.0 * np.einsum("ps,psm->pm", weight * (1.0 - s), d0))
        np.add.at(by_y1, pair, 2.0 * np.einsum("ps,psm->pm", weight, d1) / length_f[pair, None])
    by_length_e = (value / length_e**2)[:, None] * e
    by_x0 -= by_length_e
    by_x1 += by_length_e
    by_y1 += (value / length_f**2)[:, None] * f
    return value, EdgePairs(by_x0, by_x1, -(by_x0 + by_x1 + by_y1), by_y1)


def _inner_moments(z: FloatArray, tau: FloatArray, length: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrals over the second edge, y(σ) = y0 + σ τ, D = x − y: ∫ 1/|D|², ∫ D/|D|⁴ and ∫ σ D/|D|⁴.

    ``z`` = x − y0 has shape (panels, points, m), ``tau`` (panels, m), ``length`` (panels,).  With the foot
    t = ⟨z, τ⟩, the height vector h⃗ = z − t τ and w = σ − t, D = h⃗ − w τ, so all follow from
    M_k = ∫ w^k/(h² + w²)² between −t and length − t.
    """
    t = np.einsum("psm,pm->ps", z, tau)
    height = z - t[:, :, None] * tau[:, None, :]
    h2 = np.einsum("psm,psm->ps", height, height)
    h = np.sqrt(h2)
    a, b = -t, length[:, None] - t
    ra2, rb2 = h2 + a * a, h2 + b * b
    angle = np.arctan2(length[:, None] * h, h2 + a * b)  # seen from x
    outside = a * b > h2  # the foot is well outside the edge: h may vanish, so no division by h
    safe_h = np.where(outside, 1.0, h)
    # arctan(h/a) − arctan(h/b) over h, without cancellation
    i0 = np.where(
        outside,
        _arctan_ratio(length[:, None] * h / np.where(outside, h2 + a * b, 1.0))
        * length[:, None]
        / np.where(outside, h2 + a * b, 1.0),
        angle / safe_h,
    )
    m1 = 0.5 * (1.0 / ra2 - 1.0 / rb2)
    edge_term = b / rb2 - a / ra2
    m2 = 0.5 * (i0 - edge_term)
    m0 = np.where(outside, _cubic_difference(h, a, b, outside), (i0 + edge_term) / (2.0 * safe_h**2))
    d0 = m0[:, :, None] * height - m1[:, :, None] * tau[:, None, :]
    d1 = (m1 + t * m0)[:, :, None] * height - (m2 + t * m1)[:, :, None] * tau[:, None, :]
    return i0, d0, d1


def _arctan_ratio(x: FloatArray) -> FloatArray:
    """arctan(x)/x, also at 0."""
    safe = np.where(np.abs(x) < 1e-8, 1.0, x)
    return np.where(np.abs(x) < 1e-8, 1.0, np.arctan(safe) / safe)


def _cubic_difference(h: FloatArray, a: FloatArray, b: FloatArray, where: np.ndarray) -> FloatArray:
    """∫_a^b dw/(h² + w²)² for a, b of one sign and beyond h: (P(h/a)/a³ − P(h/b)/b³)/2."""
    a, b = np.where(where, a, 1.0), np.where(where, b, 1.0)
    h = np.where(where, h, 0.0)
    return 0.5 * (_arctan_cubic(h / a) / a**3 - _arctan_cubic(h / b) / b**3)


def _arctan_cubic(x: FloatArray) -> FloatArray:
    """P(x) = (arctan x − x/(1 + x²))/x³ = 2/3 − 4/5 x² + 6/7 x⁴ − …, also at 0."""
    x2 = x * x
    small = x2 < 0.01
    safe = np.where(small, 1.0, x)
    series = np.zeros_like(x2)
    for k in range(8, 0, -1):
        series = 2.0 * k / (2.0 * k + 1.0) - x2 * series
    return np.where(small, series, (np.arctan(safe) - safe / (1.0 + safe**2)) / safe**3)


def _graded_points(pairs: EdgePairs) -> Iterator[tuple[IntArray, FloatArray, FloatArray]]:
    """Quadrature points on the first edges: (pair, s, weight) with arrays (panels,), (panels, points) twice."""
    position, distance = _near_singularities(pairs)
    breaks = np.sort(np.clip(np.where(distance < 0.7, position, 0.0), 0.0, 1.0), axis=1)
    count = len(breaks)
    breaks = np.concatenate([np.zeros((count, 1)), breaks, np.ones((count, 1))], axis=1)
    delta = np.min(np.hypot(distance[:, None, :], position[:, None, :] - breaks[:, :, None]), axis=2)

    # every interval between breaks is halved, each half graded towards its end
    half = 0.5 * np.diff(breaks, axis=1)
    start = np.concatenate([breaks[:, :-1], breaks[:, 1:]], axis=1)
    signed_half = np.concatenate([half, -half], axis=1)
    width = np.concatenate([delta[:, :-1], delta[:, 1:]], axis=1)
    pair, panel = np.nonzero(signed_half)
    start, signed_half, width = start[pair, panel], signed_half[pair, panel], width[pair, panel]
    reach = np.arcsinh(np.abs(signed_half) / width)
    points = _point_count(reach)
    for n in np.unique(points):
        chosen = points == n
        u, weight = _gauss_legendre(int(n))
        u = reach[chosen, None] * u
        scale = np.copysign(width[chosen], signed_half[chosen])[:, None]
        s = start[chosen, None] + scale * np.sinh(u)
        yield pair[chosen], s, np.abs(scale) * np.cosh(u) * (reach[chosen, None] * weight)


def _near_singularities(pairs: EdgePairs) -> tuple[FloatArray, FloatArray]:
    """Complex singularities s ± iδ of the outer integrand, as s and δ, shapes (k, 3).

    They sit where the complexified distance to an end point of the second edge vanishes, and at the lines'
    closest approach if its foot lies within the second edge (otherwise the poles pass by: δ = inf).
    """
    e, f = pairs.x1 - pairs.x0, pairs.y1 - pairs.y0
    e2 = np.einsum("ij,ij->i", e, e)
    f2 = np.einsum("ij,ij->i", f, f)

    def foot(y: FloatArray) -> tuple[FloatArray, FloatArray]:
        z = y - pairs.x0
        s = np.einsum("ij,ij->i", z, e) / e2
        return s, np.linalg.norm(z - s[:, None] * e, axis=1) / np.sqrt(e2)

    (s0, delta0), (s1, delta1) = foot(pairs.y0), foot(pairs.y1)
    # distance of y0 + t f to the line of e is |g0 + t g1|, smallest at t
    z = pairs.y0 - pairs.x0
    g0 = z - s0[:, None] * e
    g1 = f - (np.einsum("ij,ij->i", f, e) / e2)[:, None] * e
    g1_square = np.einsum("ij,ij->i", g1, g1)
    crossing = g1_square > 1e-24 * f2
    t = -np.einsum("ij,ij->i", g0, g1) / np.where(crossing, g1_square, 1.0)
    crossing &= (t > 0.0) & (t < 1.0)
    s = s0 + t * (s1 - s0)
    delta = np.where(crossing, np.linalg.norm(g0 + t[:, None] * g1, axis=1) / np.sqrt(e2), np.inf)
    return np.stack([np.where(crossing, s, 0.0), s0, s1], axis=1), np.stack([delta, delta0, delta1], axis=1)


def _point_count(reach: FloatArray) -> IntArray:
    """Gauss points for a panel u in [0, reach] whose nearest singularity is iπ/2 (Bernstein ellipse)."""
    z = -1.0 + 1j * np.pi / reach
    root = np.sqrt(z * z - 1.0)
    rho = np.maximum(np.abs(z + root), np.abs(z - root))
    needed = np.ceil(_DIGITS / (2.0 * np.log(rho)))
    index = np.minimum(np.searchsorted(_POINT_COUNTS, needed), len(_POINT_COUNTS) - 1)
    return np.asarray(_POINT_COUNTS[index])


@lru_cache(maxsize=32)
def _gauss_legendre(n: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights on [0, 1]."""
    x, w = np.polynomial.legendre.leggauss(n)
    return frozen(0.5 * (x + 1.0)), frozen(0.5 * w)
