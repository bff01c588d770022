"""The barrier that a one-point rule lacks: near pairs of edges get their exact energy.

    B = Σ χ(q_IJ) (W_exact − W_mid),   q = |Δ|²/(ℓ_I + ℓ_J)²,

over ordered pairs of different components or at index distance 4 or more.  χ is a C² cutoff, 1 up to
q = 1 and 0 from q = 9/4, so B is one C² function of the vertices and vanishes on well-resolved curves.

W_exact contains ∬ ds dt/|D|² over both edges, D = Δ + (s − ½) e − (t − ½) f.  The integral along the second edge is in
closed form and without cancellation: by moments

    L(n, k) = ∫_a^b wᵏ/(h² + w²)ⁿ dw,   n = 1, 2,

h the distance of a point from the edge's line and w the position along it from the point's foot.  The one along the
first edge is by graded panels.  Derivatives are those of the exact integral, at the same points; second ones are by
complex steps.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import ClassVar

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..base import BoolArray, FloatArray, IntArray, checked_fields, dot
from ..curve import Curve, near_by_octave
from .edge_pairs import DELTA, E, EdgePairIndices, EdgePairs, F, Jet, PairTerm, arctan2
from .quadrature import gauss_legendre

NEAR = 1.0  # of q, up to which only the exact energy of a pair counts,
FAR = 2.25  # and from which only its midpoint energy does
CONTACT = 1e-16  # distance of edges, relative to their length, below which they count as that far apart
_SERIES = [(-1.0) ** k * (k + 1) / (2 * k + 3) for k in range(14)]  # of the tail, in powers of x²
_POINT_COUNTS = np.array([8, 12, 16, 24, 32, 48, 64, 96, 128])


@checked_fields
@dataclass(frozen=True)
class Barrier(PairTerm):
    """B, the difference between exact and midpoint energy over near pairs of edges.

    Midpoint contributions are subtracted for the default energy, which contains them; for others the barrier is
    Σ χ W_exact, on top of their own contributions.  If the energy has left out the pairs with χ = 1 (`replaced_pairs`),
    these contribute W_exact alone: the same sum, but nothing is added and then subtracted, which at a distance g would
    cost some 1/g² times the rounding error of g, all digits from 10⁻⁸ of an edge on.
    """

    replaces_midpoint: bool = True
    left_out: bool = False

    name: ClassVar[str] = "barrier"

    def shares(self, curve: Curve) -> Iterator[tuple[IntArray, IntArray, Callable[[EdgePairs], Jet]]]:
        """None where strands are further apart than edges are long."""
        i, j = near_pairs(curve)
        for first in range(0, len(i), 4096):  # to bound the memory, and for the processor's cache
            e, f = i[first : first + 4096], j[first : first + 4096]
            yield e, f, partial(self._excess, replaced=is_replaced(curve, e, f))

    def _excess(self, pairs: EdgePairs, replaced: BoolArray) -> Jet:
        """2 χ (W_exact − W_mid) of unordered pairs; ``replaced`` marks those that have χ = 1."""
        q, excess = closeness(pairs), exact(pairs)
        if self.replaces_midpoint:
            excess = excess - (midpoint(pairs).where(~replaced) if self.left_out else midpoint(pairs))
        return (q.compose(*cutoff(q.value)) * excess).scaled(2.0)


def cutoff(q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """χ(q), the quintic smoothstep from 1 (q ≤ 1) to 0 (q ≥ 9/4), and its derivative."""
    x = np.clip((FAR - q) / (FAR - NEAR), 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x * x)), -30.0 * (x * (1.0 - x)) ** 2 / (FAR - NEAR)


def closeness(pairs: EdgePairs) -> Jet:
    """q = |Δ|²/(|e| + |f|)², as a jet in (Δ, e, f)."""
    total = pairs.inner(E, E).sqrt() + pairs.inner(F, F).sqrt()
    return pairs.inner(DELTA, DELTA) * (total * total).reciprocal()


def midpoint(pairs: EdgePairs) -> Jet:
    """W_mid = (|e||f| + ⟨e, f⟩)/|Δ|² − 2 ⟨Δ, e⟩⟨Δ, f⟩/|Δ|⁴, the one-point rule, as a jet in (Δ, e, f)."""
    s = pairs.inner(DELTA, DELTA).reciprocal()
    p, q = pairs.inner(DELTA, E) * s, pairs.inner(DELTA, F) * s
    return (_area(pairs) + pairs.inner(E, F)) * s - (p * q).scaled(2.0)


def exact(pairs: EdgePairs) -> Jet:
    """W_exact = ∬ (1 − cos α)/r² over both edges, however near they are, as a jet in (Δ, e, f).

    For edges from x₀ to x₁ and y₀ to y₁ the cosine part is log(|x₁−y₁| |x₀−y₀| / (|x₁−y₀| |x₀−y₁|)); only ∬ 1/r² needs
    quadrature.  Relative error of the values at most 1e-8; edges must not touch.
    """

    def log_square(x: float, y: float) -> Jet:
        return pairs.inner((1.0, x, -y), (1.0, x, -y)).log()

    same = log_square(0.5, 0.5) + log_square(-0.5, -0.5)
    cosine = (same - log_square(0.5, -0.5) - log_square(-0.5, 0.5)).scaled(0.5)
    return _area(pairs) * inverse_square(pairs) - cosine


def _area(pairs: EdgePairs) -> Jet:
    return pairs.inner(E, E).sqrt() * pairs.inner(F, F).sqrt()


def replaced_pairs(curve: Curve) -> EdgePairIndices:
    """The near pairs that contribute their exact energy alone."""
    i, j = near_pairs(curve)
    replaced = is_replaced(curve, i, j)
    return i[replaced], j[replaced]


def is_replaced(curve: Curve, i: IntArray, j: IntArray) -> BoolArray:
    """Whether q ≤ 1; coordinate by coordinate, so that the answer for a pair does not depend on the others."""
    chord = (curve.midpoints[i] - curve.midpoints[j]).T
    return np.asarray(sum(c * c for c in chord) <= NEAR * (curve.edge_lengths[i] + curve.edge_lengths[j]) ** 2)


@lru_cache(maxsize=2)
def near_pairs(curve: Curve) -> tuple[IntArray, IntArray]:
    """Unordered pairs of edges with q < 9/4 that the barrier counts, as two index arrays, no longer edge first.

    A near pair has |Δ| < 3 max(ℓ_I, ℓ_J).  The last answers are kept, because energy and barrier ask the same.
    """
    ell = curve.edge_lengths
    j, i, distance = near_by_octave(curve.midpoints, ell, 2.0 * np.sqrt(FAR))
    octave = np.frexp(ell)[1]
    kept = (distance**2 < FAR * (ell[i] + ell[j]) ** 2) & ((octave[i] != octave[j]) | (i < j))
    i, j = i[kept], j[kept]
    kept = curve.mesh.index_distance(i, j) >= 4
    i, j = i[kept], j[kept]
    swapped = ell[i] > ell[j]
    return np.where(swapped, j, i), np.where(swapped, i, j)


def inverse_square(pairs: EdgePairs) -> Jet:
    """The integral as a jet in (Δ, e, f); edges must not touch."""
    k, m = pairs.delta.shape
    value, first = np.zeros(k, pairs.delta.dtype), np.zeros((k, 3, m), pairs.delta.dtype)
    length = np.sqrt(dot(pairs.f, pairs.f))
    tau = pairs.f / length[:, None]
    for pair, s, weight in graded_points(EdgePairs(*(vectors.real for vectors in pairs))):
        s, weight = s - 0.5, weight / length[pair, None]  # dt from dw
        z = pairs.delta[pair, None, :] + s[:, :, None] * pairs.e[pair, None, :]
        # D = height − w τ and t − ½ = (w + foot)/length; ∇ 1/|D|² = −2 D/|D|⁴ times (1, s, ½ − t), s from the middle
        along, size = tau[pair], length[pair, None]
        foot = np.einsum("psm,pm->ps", z, along)
        height = z - foot[:, :, None] * along[:, None, :]
        h2 = dot(height, height)
        inverse, m0, m1, m2 = moments(h2, -0.5 * size - foot, 0.5 * size - foot)
        n0, n1 = (m1 + foot * m0) / size, (m2 + foot * m1) / size
        result = np.empty((len(weight), 3, along.shape[1]), z.dtype)
        for block, (along_height, along_tau, factor) in enumerate(
            ((m0, m1, weight), (m0, m1, weight * s), (n0, n1, -weight))
        ):
            result[:, block] = -2.0 * np.einsum("ps,psm->pm", factor * along_height, height)
            result[:, block] += 2.0 * np.sum(factor * along_tau, axis=1)[:, None] * along
        np.add.at(value, pair, np.sum(weight * inverse, axis=1))
        np.add.at(first, pair, result)
    return Jet(value, first.reshape(k, 3 * m))


def graded_points(pairs: EdgePairs) -> Iterator[tuple[IntArray, FloatArray, FloatArray]]:
    """Points on first edges, (pair, s ∈ [0, 1], weight), by panels and points; a pair's weights add up to 1."""
    # The outer integrand has complex singularities s ± iδ where the complexified distance to an end point of the second
    # edge vanishes, and at the lines' closest approach if its foot lies within the second edge (otherwise the poles
    # pass by); δ is in lengths of the first edge
    e, f = pairs.e, pairs.f
    e2, f2 = dot(e, e), dot(f, f)
    to_tail, to_head = pairs.combination((-1.0, 0.5, -0.5)), pairs.combination((-1.0, 0.5, 0.5))
    s0, s1 = dot(to_tail, e) / e2, dot(to_head, e) / e2
    g0, g_head = to_tail - s0[:, None] * e, to_head - s1[:, None] * e
    # the point y0 + t f has the distance |g0 + t g1| from the line of e, smallest at t
    g1 = f - (dot(f, e) / e2)[:, None] * e
    square = dot(g1, g1)
    crossing = square > 1e-24 * f2
    t = -dot(g0, g1) / np.where(crossing, square, 1.0)
    crossing &= (t > 0.0) & (t < 1.0)
    position = np.stack([np.where(crossing, s0 + t * (s1 - s0), 0.0), s0, s1], axis=1)
    distance = np.linalg.norm(np.stack([g0 + t[:, None] * g1, g0, g_head], axis=1), axis=2) / np.sqrt(e2)[:, None]
    distance[~crossing, 0] = np.inf

    # singularities further away than so many edge lengths get no panel of their own
    breaks = np.sort(np.clip(np.where(distance < 0.7, position, 0.0), 0.0, 1.0), axis=1)
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
    # Gauss points for panels u in [0, reach] whose nearest singularity is iπ/2 (Bernstein ellipse), with a convergence
    # exponent of 40: an error of 5e-9, relative, on the hardest pairs tried, gaps to 1e-7
    z = -1.0 + 1j * np.pi / reach
    root = np.sqrt(z * z - 1.0)
    needed = np.ceil(20.0 / np.log(np.maximum(np.abs(z + root), np.abs(z - root))))
    points = _POINT_COUNTS[np.minimum(np.searchsorted(_POINT_COUNTS, needed), len(_POINT_COUNTS) - 1)]
    for n in np.unique(points):
        chosen = points == n
        u, weight = gauss_legendre(int(n))
        u = reach[chosen, None] * u
        scale = np.copysign(width[chosen], signed_half[chosen])[:, None]
        s = start[chosen, None] + scale * np.sinh(u)
        yield pair[chosen], s, np.abs(scale) * np.cosh(u) * (reach[chosen, None] * weight)


def moments(h2: FloatArray, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """L(1, 0) and L(2, k), k = 0, 1, 2, for h² ≥ 0 and a < b; points on the edge count as 10⁻¹⁶ of its length away."""
    width = b - a
    h2 = np.maximum(h2, (width * CONTACT) ** 2)
    h = np.sqrt(h2)
    ra2, rb2 = h2 + a * a, h2 + b * b
    inverse = arctan2(width * h, h2 + a * b) / h
    edge = b / rb2 - a / ra2
    m0 = (inverse + edge) / (2.0 * h2)
    # if the foot is well outside the edge, differences that are divided by h cancel: there integrals from a and
    # from b to infinity take their place
    outside = a * b > h2
    inverse[outside], m0[outside] = _outside(h[outside], a[outside], b[outside])
    return inverse, m0, 0.5 * (1.0 / ra2 - 1.0 / rb2), 0.5 * (inverse - edge)


def _outside(h: FloatArray, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """L(1, 0), which is (arctan(h/a) − arctan(h/b))/h, by the addition theorem, and L(2, 0)."""
    across = (b - a) / (h * h + a * b)
    tangent = h * across
    small = np.abs(tangent) < 1e-8
    safe = np.where(small, 1.0, tangent)
    inverse = across * np.where(small, 1.0, arctan2(safe, np.ones_like(safe)) / safe)
    return inverse, _tail(h / a) / a**3 - _tail(h / b) / b**3


def _tail(x: FloatArray) -> FloatArray:
    """∫_1^∞ du/(x² + u²)² = (arctan x − x/(1 + x²))/(2x³) = 1/3 − 2x²/5 + 3x⁴/7 − …, also at 0."""
    x2 = x * x
    small = x2 < 0.0625  # of x²: up to here the series, above it the closed form; both to 1e-13
    safe = np.where(small, 1.0, x)
    closed = (arctan2(safe, np.ones_like(safe)) - safe / (1.0 + safe**2)) / (2.0 * safe**3)
    series = polyval(np.where(small, x2, 0.0), _SERIES)
    return np.where(small, series, closed)
