"""W^{3/2,2}, the intrinsic fractional metric: the energy's order, but blind to other strands."""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve
from ..curve.distances import arc_distances
from .inner_product import MAX_DENSE_ROWS, DenseInnerProduct, InnerProduct
from .local import WithoutRule, mass
from .pairs import DifferenceForm, Stencil, stripes


@dataclass(frozen=True)
class FractionalMetric(WithoutRule):
    """Σ ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/ϱ² + ∫ u², midpoint rule, ϱ the distance along the curve."""

    name = "h3-2"
    description = "W^{3/2,2}, intrinsic"
    extends_penalty = True
    most_vertices = MAX_DENSE_ROWS

    def at(self, curve: Curve) -> InnerProduct:
        """Dense: every pair of edges weighs in."""
        ell, slope = curve.mesh.at_tails(curve.edge_lengths), Stencil.slope(curve)
        form = DifferenceForm(curve.mesh)
        for stripe in stripes(curve.mesh):
            rho = arc_distances(curve, 0.5, 0.5, stripe.rows, stripe.columns)
            stripe.exclude_neighbours(curve.mesh, rho)
            weights = np.multiply.outer(ell[stripe.rows], ell[stripe.columns])
            weights /= np.square(rho, out=rho)
            form.add(stripe, weights, slope, slope)
        return DenseInnerProduct(form.assembled() + mass(curve).toarray())
