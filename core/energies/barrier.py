"""The barrier that a one-point rule lacks: near pairs of edges get their exact energy instead.

    B = Σ χ(q_IJ) (W_exact − W_mid),   q = |Δ|²/(ℓ_I + ℓ_J)²,

over ordered pairs of different components or at index distance 4 or more.  χ is a C² cutoff, 1 up to
q = 1 and 0 from q = 9/4, so B is one C² function of the vertices and vanishes on well-resolved curves.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy.sparse as sp

from ..arguments import checked_fields
from ..curve import Curve
from ..types import BoolArray, FloatArray, IntArray
from .contributions import Contributions
from .edge_pairs import EdgePairs, scatter_first, scatter_second
from .jets import Jet
from .near_pairs import FAR, NEAR, is_replaced, near_pairs


@checked_fields
@dataclass(frozen=True)
class Barrier:
    """B, the difference between exact and midpoint energy over near pairs of edges.

    Parameters
    ----------
    replaces_midpoint
        Whether the midpoint contributions are subtracted, as is right for the default energy that contains them.
        Other energies do not: theirs is Σ χ W_exact, a positive barrier on top of what they say themselves.
    left_out
        Whether the energy leaves the pairs with χ = 1 out (`replaced_pairs`), so that theirs is W_exact alone.  The sum
        is the same, but nothing is added that is subtracted again: at a distance g that would be some 1/g² times the
        rounding error of g, which drowns it from 10⁻⁸ of an edge on.
    """

    replaces_midpoint: bool = True
    left_out: bool = False

    name: ClassVar[str] = "barrier"
    description: ClassVar[str] = "exact minus midpoint energy of near pairs of edges"

    def value(self, curve: Curve) -> float:
        """B; 0 when strands are further apart than edges are long."""
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """B and its derivative with respect to the vertices, shape (n, m)."""
        total, first = 0.0, _by_pair(curve)
        for block, i, j in _blocks(curve, 4096):
            jet = self._contributions(EdgePairs.of(curve, i, j), is_replaced(curve, i, j))
            total += float(jet.value.sum())
            first[block] = jet.first
        # unordered pairs are listed, the sum is over ordered ones
        return 2.0 * total, 2.0 * scatter_first(curve.mesh, *near_pairs(curve), first)

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative D²B, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        return np.asarray(self.sparse_hessian(curve).toarray())

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        """D²B as a sparse matrix: it couples near edges only."""
        total = sp.csr_array((curve.vertices.size, curve.vertices.size))
        for _, i, j in _blocks(curve, 16384):
            # the jets' matrices, many of 3m × 3m for each pair, should stay in the processor's cache
            parts = [slice(first, first + 128) for first in range(0, len(i), 128)]
            pairs = [(EdgePairs.of(curve, i[s], j[s]), is_replaced(curve, i[s], j[s])) for s in parts]
            second = [self._contributions(p.with_coordinates(), replaced).second for p, replaced in pairs]
            total = total + scatter_second(curve.mesh, i, j, 2.0 * np.concatenate(second))
        return total

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²B v for ``v`` of shape (n, m); shape (n, m)."""
        first = _by_pair(curve)
        for block, i, j in _blocks(curve, 4096):
            jet = self._contributions(EdgePairs.of(curve, i, j).moving(curve.mesh, i, j, v), is_replaced(curve, i, j))
            first[block] = jet.second[:, :, 0]
        return 2.0 * scatter_first(curve.mesh, *near_pairs(curve), first)

    def _contributions(self, pairs: EdgePairs, replaced: BoolArray) -> Jet:
        """χ (W_exact − W_mid) of pairs of edges, those ``replaced`` that have χ = 1."""
        w = Contributions(pairs)
        q = w.closeness()
        excess = w.exact()
        if self.replaces_midpoint:
            excess = excess - (w.midpoint().where(~replaced) if self.left_out else w.midpoint())
        return q.compose(*cutoff(q.value)) * excess


def _blocks(curve: Curve, size: int) -> Iterator[tuple[slice, IntArray, IntArray]]:
    """The near pairs in blocks, to bound the memory."""
    i, j = near_pairs(curve)
    for first in range(0, len(i), size):
        block = slice(first, first + size)
        yield block, i[block], j[block]


def _by_pair(curve: Curve) -> FloatArray:
    """Room for the derivative of each near pair by (Δ, e, f); shape (pairs, 3m)."""
    return np.empty((len(near_pairs(curve)[0]), 3 * curve.dimension))


def cutoff(q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """χ(q), the quintic smoothstep from 1 (q ≤ 1) to 0 (q ≥ 9/4), and its first and second derivative."""
    x = np.clip((FAR - q) / (FAR - NEAR), 0.0, 1.0)
    product = x * (1.0 - x)
    slope, curvature = 30.0 * product**2, 60.0 * product * (1.0 - 2.0 * x)
    chi = np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x * x))
    return chi, -slope / (FAR - NEAR), curvature / (FAR - NEAR) ** 2
