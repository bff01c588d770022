"""The inner product J_C of Theorem 4.1 in [RS21], discretised as in Section 6.1.2.

For functions U on the vertices, u their piecewise linear interpolation and ΔU_I = U(I↑) − U(I↓),
⟨U, U⟩ is the sum over ordered pairs of edges with disjoint closures, ϱ the distance along the curve, of

1. ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|² Σ_ij ω_i ω_j / r_ij²
2. ℓ_I ℓ_J Σ_ij ω_i ω_j |u_I(t_i) − u_J(t_j)|² / r_ij² · (1/r_ij² − 1/ϱ_ij²)

and of 3. |∫ u ds|².  Where an arc is straight all three vanish for affine functions of mean 0, and where it has a few
edges for others too, so there is 4. ∫ |u'|² ds over all arcs, of lower order.

The Gram matrix is A ⊗ Id_m (footnote 6): only A, of shape (n, n), is assembled.
"""

from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.linalg import blas
from scipy.spatial.distance import cdist

from ..arguments import checked_fields
from ..curve import Curve
from ..curve.distances import arc_distance_of_pairs, arc_distances, points_at
from ..quadrature import MIDPOINT, Rule
from ..types import FloatArray, IntArray
from .inner_product import MAX_DENSE_ROWS, DenseInnerProduct, InnerProduct
from .local import WithoutRule, lumped_mass, mass
from .pairs import DifferenceForm, Stencil, Stripe, stripes

# In both kernels r and ϱ are at least this many times ℓ_I + ℓ_J: the 1/r⁴ of nearer pairs would leave no digits to the
# others, and forbid the very motion that brings strands apart.  On curves that their mesh resolves it changes nothing.
MIN_DISTANCE = 0.25


@checked_fields
@dataclass(frozen=True)
class MoebiusMetric:
    """Σ ℓ_I ℓ_J (|ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/r² + |u_I − u_J|²/r² (1/r² − 1/ϱ²)) + |∫ u|², by a quadrature rule.

    The metric in which the Möbius energy's gradient flow is an ordinary differential equation.

    Parameters
    ----------
    rule
        The quadrature rule on every edge, by default the midpoint rule.
    """

    rule: Rule = MIDPOINT
    name = "moebius"
    description = "J_C of Theorem 4.1, extrinsic W^{3/2,2}"
    extends_penalty = True
    most_vertices = MAX_DENSE_ROWS

    def with_rule(self, rule: Rule) -> "MoebiusMetric":
        return MoebiusMetric(rule)

    def at(self, curve: Curve) -> InnerProduct:
        mesh, slope, weights = curve.mesh, Stencil.slope(curve), _PairWeights(curve, self.rule)
        points = list(zip(self.rule.points, self.rule.weights, strict=True))
        form = DifferenceForm(mesh)
        for stripe in stripes(mesh):
            for (t_i, omega_i), (t_j, omega_j) in product(points, repeat=2):
                inverse, density = weights.at(t_i, t_j, stripe)
                inverse *= omega_i * omega_j
                density *= omega_i * omega_j
                form.add(stripe, inverse, slope, slope)
                form.add(stripe, density, Stencil.value(mesh, t_i), Stencil.value(mesh, t_j))
        gram = form.assembled()
        _add_arc_stiffness(gram, curve)
        return DenseInnerProduct(blas.dsyr(1.0, lumped_mass(curve), a=gram, lower=1, overwrite_a=1))


class PairKernels(NamedTuple):
    """The kernels of terms 1 and 2 of J_C for some pairs of edges, by the midpoint rule; shapes (pairs,)."""

    inverse: FloatArray  # 1/r²
    density: FloatArray  # 1/r² (1/r² − 1/ϱ²)


def pair_kernels(curve: Curve, i: IntArray, j: IntArray) -> PairKernels:
    """The kernels of edges ``i`` and ``j``, elementwise."""
    nearest = (MIN_DISTANCE * (curve.edge_lengths[i] + curve.edge_lengths[j])) ** 2
    chord = curve.midpoints[i] - curve.midpoints[j]
    inverse = 1.0 / np.maximum(np.einsum("km,km->k", chord, chord), nearest)
    rho = arc_distance_of_pairs(curve, i, j, 0.5)
    return PairKernels(inverse, inverse * (inverse - 1.0 / np.maximum(rho * rho, nearest)))


def _add_arc_stiffness(gram: FloatArray, curve: Curve) -> None:
    """Add ∫ |u'|² over the arcs, `arc_stiffness`, to the lower triangle."""
    edges = curve.mesh.arc_edges
    tails, heads, slope = curve.mesh.tails[edges], curve.mesh.heads[edges], 1.0 / curve.edge_lengths[edges]
    gram[tails, tails] += slope
    gram[heads, heads] += slope
    gram[heads, tails] -= slope  # along an arc numbers grow


class _PairWeights:
    """ℓ_I ℓ_J/r² and ℓ_I ℓ_J/r² (1/r² − 1/ϱ²), 0 where closures meet and where no edge begins."""

    def __init__(self, curve: Curve, rule: Rule) -> None:
        mesh = curve.mesh
        self._curve = curve
        self._ell, self._width = mesh.at_tails(curve.edge_lengths), mesh.at_tails(curve.edge_lengths, 1.0)
        self._points = {t: mesh.at_tails(points_at(curve, t), curve.vertices) for t in rule.points}

    def at(self, t_i: float, t_j: float, stripe: Stripe) -> tuple[FloatArray, FloatArray]:
        """Both for a stripe, taken at t_i of edges I and t_j of edges J; shapes (rows, columns)."""
        rows, columns = stripe.rows, stripe.columns
        rho = arc_distances(self._curve, t_i, t_j, rows, columns)
        r2 = cdist(self._points[t_i][rows], self._points[t_j][columns], "sqeuclidean")
        nearest = MIN_DISTANCE * np.add.outer(self._width[rows], self._width[columns])
        np.maximum(rho, nearest, out=rho)
        np.maximum(r2, np.square(nearest, out=nearest), out=r2)
        stripe.exclude_neighbours(self._curve.mesh, r2)
        s = np.divide(1.0, r2, out=r2)
        inverse = np.multiply.outer(self._ell[rows], self._ell[columns])
        inverse *= s
        s -= np.divide(1.0, np.square(rho, out=rho), out=rho)
        s *= inverse  # 0 for neighbours
        return inverse, s


@dataclass(frozen=True)
class FractionalMetric(WithoutRule):
    """Σ ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/ϱ² + ∫ u², midpoint rule, ϱ the distance along the curve."""

    name = "h3-2"
    description = "W^{3/2,2}, intrinsic"
    extends_penalty = True
    most_vertices = MAX_DENSE_ROWS

    def at(self, curve: Curve) -> InnerProduct:
        ell, slope = curve.mesh.at_tails(curve.edge_lengths), Stencil.slope(curve)
        form = DifferenceForm(curve.mesh)
        for stripe in stripes(curve.mesh):
            rho = arc_distances(curve, 0.5, 0.5, stripe.rows, stripe.columns)
            stripe.exclude_neighbours(curve.mesh, rho)
            weights = np.multiply.outer(ell[stripe.rows], ell[stripe.columns])
            weights /= np.square(rho, out=rho)
            form.add(stripe, weights, slope, slope)
        return DenseInnerProduct(form.assembled() + mass(curve).toarray())
