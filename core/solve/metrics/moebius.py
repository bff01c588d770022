"""The inner product J_C of Theorem 4.1 in [RS21], discretised as in Section 6.1.2, and the intrinsic W^{3/2,2}.

For functions U on the vertices, u their piecewise linear interpolation and ΔU_I = U(I↑) − U(I↓),
⟨U, U⟩ is the sum over ordered pairs of edges with disjoint closures, ϱ the distance along the curve, of

1. ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|² Σ_ij ω_i ω_j / r_ij²
2. ℓ_I ℓ_J Σ_ij ω_i ω_j |u_I(t_i) − u_J(t_j)|² / r_ij² · (1/r_ij² − 1/ϱ_ij²)

and of 3. |∫ u ds|².  Where an arc is straight all three vanish for affine functions of mean 0, and where it has a few
edges for others too, so there is 4. ∫ |u'|² ds over all arcs, of lower order.

The Gram matrix is A ⊗ Id_m (footnote 6): only A, of shape (n, n), is assembled.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.linalg import blas
from scipy.spatial.distance import cdist

from ...base import FloatArray, IntArray, checked_fields, dot, number
from ...curve import Curve, Mesh, arc_distance_of_pairs, arc_distances, points_at
from ...energies import Rule
from ...energies.edge_pairs import ROWS_TIMES_COLUMNS
from ...energies.quadrature import MIDPOINT
from .inner_product import DenseInnerProduct, InnerProduct
from .local import WithoutRule, lumped_mass, mass, stiffness


class Stencil(NamedTuple):
    """A linear map from vertices to edges, (B U)_I = tail_I U(I↓) + head_I U(I↑); both of shape (n,).

    Here an edge has the number of its tail.  The vertex where an arc ends stands for an edge from there to the arc's
    first vertex, which makes every component a cycle: its length, and with it its weight in all sums, is 0.
    """

    tail: FloatArray
    head: FloatArray

    @classmethod
    def value(cls, mesh: Mesh, t: float) -> "Stencil":
        """The values at parameter ``t`` of each edge."""
        return cls(np.full(mesh.size, 1.0 - t), np.full(mesh.size, t))

    @classmethod
    def slope(cls, curve: Curve) -> "Stencil":
        """ΔU_I/ℓ_I."""
        slope = curve.mesh.at_tails(1.0 / curve.edge_lengths)
        return cls(-slope, slope)


class Stripe(NamedTuple):
    """The pairs of edges that make entries (v, w), v ≤ w, of a form, for consecutive vertices v of one component."""

    vertices: slice  # the vertices v
    rows: IntArray  # the edges that they belong to: the one before the first vertex, then those that begin at vertices
    columns: slice  # the edges that the vertices from the first v on belong to

    def exclude_neighbours(self, mesh: Mesh, distance: FloatArray) -> None:
        """Set the distances, shape (rows, columns), of edges that share a vertex to inf."""
        for partner in (self.rows, mesh.cycle[self.rows], mesh.anticycle[self.rows]):
            row = np.flatnonzero(partner >= self.columns.start)
            distance[row, partner[row] - self.columns.start] = np.inf


def stripes(mesh: Mesh) -> Iterator[Stripe]:
    """Cover the upper triangle, in pieces that fit the processor's cache."""
    for component in mesh.slices:
        first = component.start
        while first < component.stop:
            last = min(component.stop, first + max(1, ROWS_TIMES_COLUMNS // (mesh.size - first)))
            before = int(mesh.anticycle[first])
            columns = slice(min(first, before), mesh.size)
            yield Stripe(slice(first, last), np.concatenate([[before], np.arange(first, last)]), columns)
            first = last


class DifferenceForm:
    """Collects the matrix of U ↦ Σ w_IJ ((B U)_I − (B' U)_J)² over ordered pairs, symmetric in I and J."""

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        self._cross = np.zeros((mesh.size, mesh.size))  # Bᵀ w B', the upper triangle
        self._squares = np.zeros((3, mesh.size))  # of tail and head of each edge, and half of their product

    def add(self, stripe: Stripe, weights: FloatArray, left: Stencil, right: Stencil) -> None:
        """Add a stripe of a term, weights (rows, columns) being changed; Bᵀ w B' by rows, then by columns, is cheap."""
        vertices, rows, columns = stripe
        own = vertices.start - columns.start
        # the pairs of the stripe's own edges come in either order, and so count by their rows alone
        inside, beyond = weights[1:, own:], weights[1:, own + len(rows) - 1 :]
        self._add_squares(vertices, left, inside.sum(axis=1))
        self._add_squares(slice(vertices.stop, None), right, beyond.sum(axis=0))
        at_vertices = left.tail[rows[1:], None] * weights[1:]
        weights *= left.head[rows, None]
        at_vertices += weights[:-1]
        at_tails = at_vertices[:, own:] * right.tail[vertices.start :]
        at_vertices *= right.head[columns]
        at_tails += at_vertices.take(self._mesh.anticycle[vertices.start :] - columns.start, axis=1)
        self._cross[vertices, vertices.start :] += at_tails

    def assembled(self) -> FloatArray:
        """Finish: the matrix, shape (n, n), in Fortran order, of which only the lower triangle counts."""
        mesh = self._mesh
        tail, head, mixed = self._squares
        form = np.multiply(self._cross, -2.0, out=self._cross)
        tails, heads = np.arange(mesh.size), mesh.cycle
        np.add.at(form, (tails, tails), 2.0 * tail)
        np.add.at(form, (heads, heads), 2.0 * head)
        np.add.at(form, (np.minimum(tails, heads), np.maximum(tails, heads)), 2.0 * mixed)
        return form.T

    def _add_squares(self, edges: slice, stencil: Stencil, weights: FloatArray) -> None:
        tail, head = stencil.tail[edges], stencil.head[edges]
        self._squares[:, edges] += weights * np.stack([tail * tail, head * head, tail * head])


@checked_fields
@dataclass(frozen=True)
class MoebiusMetric:
    """Σ ℓ_I ℓ_J (|ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/r² + |u_I − u_J|²/r² (1/r² − 1/ϱ²)) + |∫ u|², by a quadrature rule.

    The metric in which the Möbius energy's gradient flow is an ordinary differential equation.
    """

    rule: Rule = MIDPOINT  # on every edge
    # In both kernels r and ϱ are at least this many times ℓ_I + ℓ_J: the 1/r⁴ of nearer pairs would leave no digits to
    # others, and forbid the very motion that brings strands apart.  On curves that their mesh resolves nothing changes.
    least_distance: float = number(0.25)
    name = "moebius"
    description = "J_C of Theorem 4.1, extrinsic W^{3/2,2}"
    extends_penalty = True
    most_vertices = DenseInnerProduct.most_rows

    def with_rule(self, rule: Rule) -> "MoebiusMetric":
        return replace(self, rule=rule)

    def at(self, curve: Curve) -> InnerProduct:
        mesh, slope, rule, form = curve.mesh, Stencil.slope(curve), self.rule, DifferenceForm(curve.mesh)
        ell, width = mesh.at_tails(curve.edge_lengths), mesh.at_tails(curve.edge_lengths, 1.0)
        points = {t: mesh.at_tails(points_at(curve, t), curve.vertices) for t in rule.points}
        for stripe in stripes(mesh):
            rows, columns = stripe.rows, stripe.columns
            for (t_i, omega_i), (t_j, omega_j) in product(zip(rule.points, rule.weights, strict=True), repeat=2):
                # term 1, ω_i ω_j ℓ_I ℓ_J/r², and term 2, that times 1/r² − 1/ϱ², where arrays are used again;
                # 0 where closures meet, as r is infinite there, and where no edge begins, whose ℓ is 0
                rho = arc_distances(curve, t_i, t_j, rows, columns)
                r2 = cdist(points[t_i][rows], points[t_j][columns], "sqeuclidean")
                nearest = self.least_distance * np.add.outer(width[rows], width[columns])
                np.maximum(rho, nearest, out=rho)
                np.maximum(r2, np.square(nearest, out=nearest), out=r2)
                stripe.exclude_neighbours(mesh, r2)
                density = np.divide(1.0, r2, out=r2)
                inverse = np.multiply.outer(omega_i * omega_j * ell[rows], ell[columns])
                inverse *= density
                density -= np.divide(1.0, np.square(rho, out=rho), out=rho)
                density *= inverse
                form.add(stripe, inverse, slope, slope)
                form.add(stripe, density, Stencil.value(mesh, t_i), Stencil.value(mesh, t_j))
        gram, arcs = form.assembled(), stiffness(curve, mesh.arc_edges).tocoo()
        gram[arcs.coords] += arcs.data  # term 4, and term 3
        return DenseInnerProduct(blas.dsyr(1.0, lumped_mass(curve), a=gram, lower=1, overwrite_a=1))


class PairKernels(NamedTuple):
    """The kernels of terms 1 and 2 of J_C for some pairs of edges, by the midpoint rule; shapes (pairs,)."""

    inverse: FloatArray  # 1/r²
    density: FloatArray  # 1/r² (1/r² − 1/ϱ²)


def pair_kernels(curve: Curve, i: IntArray, j: IntArray) -> PairKernels:
    """The kernels of edges ``i`` and ``j``, elementwise."""
    nearest = (MoebiusMetric.least_distance * (curve.edge_lengths[i] + curve.edge_lengths[j])) ** 2
    chord = curve.midpoints[i] - curve.midpoints[j]
    inverse = 1.0 / np.maximum(dot(chord, chord), nearest)
    rho = arc_distance_of_pairs(curve, i, j, 0.5)
    return PairKernels(inverse, inverse * (inverse - 1.0 / np.maximum(rho * rho, nearest)))


@dataclass(frozen=True)
class FractionalMetric(WithoutRule):
    """Σ ℓ_I ℓ_J |ΔU_I/ℓ_I − ΔU_J/ℓ_J|²/ϱ² + (2π/L)³ ∫ u², midpoint rule, ϱ the distance along the curve."""

    name = "h3-2"
    description = "W^{3/2,2}, intrinsic"
    extends_penalty = True
    most_vertices = DenseInnerProduct.most_rows

    def at(self, curve: Curve) -> InnerProduct:
        ell, slope = curve.mesh.at_tails(curve.edge_lengths), Stencil.slope(curve)
        form = DifferenceForm(curve.mesh)
        for stripe in stripes(curve.mesh):
            rho = arc_distances(curve, 0.5, 0.5, stripe.rows, stripe.columns)
            stripe.exclude_neighbours(curve.mesh, rho)
            weights = np.multiply.outer(ell[stripe.rows], ell[stripe.columns])
            weights /= np.square(rho, out=rho)
            form.add(stripe, weights, slope, slope)
        return DenseInnerProduct(form.assembled() + mass(curve, 1.5).toarray())
