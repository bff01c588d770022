"""The local Sobolev metrics that J_C is compared with: L², W^{1,2} and W^{2,2}.

Each is a mass term plus ∫⟨u⁽ˢ⁾, v⁽ˢ⁾⟩ for piecewise linear functions; lengths are in the program's units, in
which a component is 4 to 8 long, so that the two terms weigh alike.
"""

from dataclasses import dataclass
from typing import Self

import scipy.sparse as sp

from ..curve import Curve
from ..quadrature import Rule
from ..types import FloatArray, IntArray
from .inner_product import MAX_SPARSE_ROWS, InnerProduct, SparseInnerProduct


def mass(curve: Curve) -> sp.csr_array:
    """Matrix of ∫ u v for piecewise linear u, v; shape (n, n)."""
    average, difference = curve.mesh.average, curve.mesh.difference
    ell = sp.diags_array(curve.edge_lengths)
    # on one edge ∫ u² = ℓ (ū² + (Δu)²/12)
    return sp.csr_array(average.T @ ell @ average + difference.T @ (ell / 12.0) @ difference)


def stiffness(curve: Curve, edges: IntArray | slice = slice(None)) -> sp.csr_array:
    """Matrix of ∫ u' v' for piecewise linear u, v, over all edges or some; shape (n, n)."""
    difference = curve.mesh.difference[edges]
    return sp.csr_array(difference.T @ sp.diags_array(1.0 / curve.edge_lengths[edges]) @ difference)


def lumped_mass(curve: Curve) -> FloatArray:
    """∫ of each hat function; shape (n,)."""
    return 0.5 * curve.mesh.scatter(curve.edge_lengths, curve.edge_lengths)


class WithoutRule:
    """A metric whose integrals are exact or by one fixed rule."""

    rule = None
    most_vertices = MAX_SPARSE_ROWS

    def with_rule(self, _rule: Rule) -> Self:
        return self


@dataclass(frozen=True)
class LocalMetric(WithoutRule):
    """∫ u² and, for order s > 0, ∫|u⁽ˢ⁾|², the second derivative by the lumped mass: K M⁻¹ K."""

    name: str
    description: str
    order: int

    @property
    def extends_penalty(self) -> bool:
        return self.order > 0

    def at(self, curve: Curve) -> InnerProduct:
        if not self.order:
            return SparseInnerProduct(mass(curve))
        derivative = k = stiffness(curve)
        if self.order == 2:
            derivative = k @ sp.diags_array(1.0 / lumped_mass(curve)) @ k
        return SparseInnerProduct(derivative + mass(curve))


L2, H1, H2 = LocalMetric("l2", "L²", 0), LocalMetric("h1", "W^{1,2}", 1), LocalMetric("h2", "W^{2,2}", 2)
