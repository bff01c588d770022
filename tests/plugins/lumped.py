"""A metric: L² by the trapezoidal rule, whose matrix is diagonal."""

from dataclasses import dataclass

import scipy.sparse as sp

from ...curve import Curve
from .inner_product import InnerProduct, SparseInnerProduct
from .local import WithoutRule, lumped_mass


@dataclass(frozen=True)
class LumpedMetric(WithoutRule):
    """Σ (ℓ_I + ℓ_J)/2 |U|², over the vertices between edges I and J."""

    name = "lumped"
    description = "L², lumped"
    extends_penalty = False

    def at(self, curve: Curve) -> InnerProduct:
        """Diagonal."""
        return SparseInnerProduct(sp.csr_array(sp.diags_array(lumped_mass(curve))))
