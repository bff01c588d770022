"""The barrier that a one-point rule lacks: near pairs of edges get their exact energy.

    B = Σ χ(q_IJ) (W_exact − W_mid),   q = |Δ|²/(ℓ_I + ℓ_J)²,

over ordered pairs of different components or at index distance 4 or more.  χ is a C² cutoff, 1 up to
q = 1 and 0 from q = 9/4, so B is one C² function of the vertices and vanishes on well-resolved curves.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
import scipy.sparse as sp

from ..base.arguments import checked_fields
from ..base.types import BoolArray, FloatArray, IntArray
from ..curve import Curve
from ..curve.distances import near_by_octave
from .edge_pairs import DELTA, E, EdgePairIndices, EdgePairs, F, Jet, change, scatter_first, scatter_second, stepped
from .inverse_square import inverse_square

NEAR = 1.0  # of q, up to which only the exact energy of a pair counts,
FAR = 2.25  # and from which only its midpoint energy does


@checked_fields
@dataclass(frozen=True)
class Barrier:
    """B, the difference between exact and midpoint energy over near pairs of edges.

    Midpoint contributions are subtracted for the default energy, which contains them; for others the barrier is
    Σ χ W_exact, on top of their own contributions.  If the energy has left out the pairs with χ = 1 (`replaced_pairs`),
    these contribute W_exact alone: the same sum, but nothing is added and then subtracted, which at a distance g would
    cost some 1/g² times the rounding error of g, all digits from 10⁻⁸ of an edge on.
    """

    replaces_midpoint: bool = True
    left_out: bool = False

    name: ClassVar[str] = "barrier"

    def value(self, curve: Curve) -> float:
        """B; 0 when strands are further apart than edges are long."""
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        value, first = self._sum(curve, curve.vertices)
        return float(value), first

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """D²B as a sparse matrix: it couples near edges only."""
        total = sp.csr_array((curve.vertices.size, curve.vertices.size))
        for i, j in _blocks(curve):
            pairs, replaced = EdgePairs.of(curve.mesh, curve.vertices, i, j), is_replaced(curve, i, j)
            second = [change(self._contributions(each, replaced).first) for each in pairs.along_coordinates()]
            total = total + scatter_second(curve.mesh, i, j, 2.0 * np.stack(second, axis=2))
        return total

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        return change(self._sum(curve, stepped(curve.vertices, v))[1])

    def _sum(self, curve: Curve, vertices: FloatArray) -> tuple[FloatArray, FloatArray]:
        """B and its derivative at a curve's vertices, or after a complex step from them."""
        total, first = np.zeros((), vertices.dtype), [np.empty((0, 3 * curve.dimension), vertices.dtype)]
        for i, j in _blocks(curve):
            jet = self._contributions(EdgePairs.of(curve.mesh, vertices, i, j), is_replaced(curve, i, j))
            total = total + jet.value.sum()
            first.append(jet.first)
        # unordered pairs are listed, the sum is over ordered ones
        return 2.0 * total, 2.0 * scatter_first(curve.mesh, *near_pairs(curve), np.concatenate(first))

    def _contributions(self, pairs: EdgePairs, replaced: BoolArray) -> Jet:
        """χ (W_exact − W_mid) of pairs of edges; ``replaced`` marks those that have χ = 1."""
        q, excess = closeness(pairs), exact(pairs)
        if self.replaces_midpoint:
            excess = excess - (midpoint(pairs).where(~replaced) if self.left_out else midpoint(pairs))
        return q.compose(*cutoff(q.value)) * excess


def _blocks(curve: Curve) -> Iterator[tuple[IntArray, IntArray]]:
    """The near pairs in blocks, to bound the memory and for the processor's cache."""
    i, j = near_pairs(curve)
    for first in range(0, len(i), 4096):
        yield i[first : first + 4096], j[first : first + 4096]


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
