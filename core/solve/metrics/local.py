"""The local Sobolev metrics that J_C is compared with: L², W^{1,2} and W^{2,2}.

Each is a mass term plus ∫⟨u⁽ˢ⁾, v⁽ˢ⁾⟩ for piecewise linear functions.  The mass has the weight (2π/L)²ˢ, L the length
of the component: the two weigh alike on the longest waves, whatever the size of the curve.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy.sparse as sp

from ...base import FloatArray, IntArray
from ...curve import Curve
from ...energies import Rule
from .inner_product import InnerProduct, SparseInnerProduct


def mass(curve: Curve, order: float = 0.0) -> sp.csr_array:
    """Matrix of (2π/L)²ˢ ∫ u v for piecewise linear u, v and an order s; shape (n, n)."""
    average, difference = curve.mesh.average, curve.mesh.difference
    waves = (2.0 * np.pi / curve.component_lengths) ** (2.0 * order)
    ell = sp.diags_array(curve.edge_lengths * waves[curve.mesh.edge_component])
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
    most_vertices = SparseInnerProduct.most_rows

    def with_rule(self, _rule: Rule) -> Self:
        return self


@dataclass(frozen=True)
class L2Metric(WithoutRule):
    """∫ u²."""

    name = "l2"
    description = "L²"
    extends_penalty = False

    def at(self, curve: Curve) -> InnerProduct:
        return SparseInnerProduct(mass(curve))


@dataclass(frozen=True)
class H1Metric(WithoutRule):
    """∫ u'² + (2π/L)² ∫ u²."""

    name = "h1"
    description = "W^{1,2}"
    extends_penalty = True

    def at(self, curve: Curve) -> InnerProduct:
        return SparseInnerProduct(stiffness(curve) + mass(curve, 1.0))


@dataclass(frozen=True)
class H2Metric(WithoutRule):
    """∫ u''² + (2π/L)⁴ ∫ u², the second derivative by the lumped mass: K M⁻¹ K."""

    name = "h2"
    description = "W^{2,2}"
    extends_penalty = True

    def at(self, curve: Curve) -> InnerProduct:
        k = stiffness(curve)
        bending = k @ sp.diags_array(1.0 / lumped_mass(curve)) @ k
        return SparseInnerProduct(bending + mass(curve, 2.0))
