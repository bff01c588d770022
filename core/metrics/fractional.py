"""W^{3/2,2}, the intrinsic fractional metric: the energy's order, but blind to other strands."""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve
from .inner_product import MAX_DENSE_ROWS, DenseInnerProduct, InnerProduct
from .local import WithoutRule, mass
from .pairs import arc_distances, difference_form, excluding_neighbours, row_blocks, slopes


@dataclass(frozen=True)
class FractionalMetric(WithoutRule):
    """Σ ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/ϱ² + ∫ u², midpoint rule, ϱ the distance along the curve."""

    name = "h3-2"
    description = "W^{3/2,2}, intrinsic"
    extends_penalty = True
    most_vertices = MAX_DENSE_ROWS

    def at(self, curve: Curve) -> InnerProduct:
        """Dense: every pair of edges weighs in."""
        ell = curve.edge_lengths
        weights = np.empty((len(curve), len(curve)))
        for rows in row_blocks(curve.mesh):
            rho = excluding_neighbours(arc_distances(curve, 0.5, 0.5, rows), curve.mesh, rows)
            weights[rows] = ell[rows, None] * ell[None, :] / rho**2
        slope = slopes(curve)
        return DenseInnerProduct(difference_form(weights, slope, slope) + mass(curve).toarray())
