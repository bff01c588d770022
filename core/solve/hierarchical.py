"""Inner products of order 3/2 by products in O(N log N), and solutions with them by conjugate gradients.

A metric has to be one symmetric and positive definite operator in gradients, projections and norms, but it moves no
minimiser: so on a block its kernel may be a single number, the value at the middle edges.  Relative to the exact
J_C the eigenvalues are between 0.85 and 1.2, on smooth curves and on tangles, and with many short arcs between 0.7 and
1.5.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..base.errors import OptionError
from ..base.types import FloatArray
from ..curve import Curve
from ..curve.distances import arc_distance_of_pairs
from ..energies.hierarchy.blocks import BlockList
from ..energies.quadrature import MIDPOINT, Rule
from .constraints import ConstraintDerivative
from .metrics import FractionalMetric, Metric, MoebiusMetric
from .metrics.inner_product import DenseInnerProduct, InnerProduct, SparseInnerProduct
from .metrics.local import lumped_mass, mass, stiffness
from .metrics.moebius import pair_kernels
from .pair_forms import PairForms, RunningSum
from .saddle import TangentSpace
from .saddle.iterative import IterativeTangentSpace, Tolerances
from .saddle.krylov import conjugate_gradients, relative
from .saddle.models import Resolvents, TwoLevel
from .saddle.symbol import Circulants

FarForm = tuple[RunningSum, sp.csr_array]
MAX_VERTICES = 200_000  # some 3 GB, and half a minute a step


@dataclass(frozen=True, eq=False)
class CompressedInnerProduct:
    """A = S + Σ Bᵀ Q B + V Vᵀ, and S + Σ Bᵀ Q B on functions constant on each component, or near it: the coupling."""

    curve: Curve  # the domain of the functions
    local: sp.csr_array  # S, sparse, shape (n, n)
    far: tuple[FarForm, ...]  # each B, running sums, and its Q, sparse, shape (edges + 1, edges + 1)
    vectors: FloatArray  # V, shape (n, r) for a small r
    coupling: sp.csr_array  # shape (components, components)
    tolerances: Tolerances  # for everything that is solved with it

    def apply(self, u: FloatArray) -> FloatArray:
        product = self.local @ u
        for running, form in self.far:
            product += running.apply_transpose(form @ running.apply(u))
        return np.asarray(product + self.vectors @ (self.vectors.T @ u))

    def solve(self, f: FloatArray) -> FloatArray:
        return conjugate_gradients(self.apply, relative(self.model.solve, 1e-10), f, 1000)

    def plus(self, other: InnerProduct, weight: float = 1.0) -> InnerProduct:
        """The sum: compressed with a sparse one or another compressed one, otherwise dense."""
        if isinstance(other, SparseInnerProduct):
            indicators = _indicators(self.curve)
            coupling = indicators.T @ other.matrix @ indicators
            return replace(self, local=self.local + weight * other.matrix, coupling=self.coupling + weight * coupling)
        if isinstance(other, CompressedInnerProduct):
            return replace(
                self,
                local=self.local + weight * other.local,
                far=self.far + tuple((running, weight * form) for running, form in other.far),
                vectors=np.hstack([self.vectors, np.sqrt(weight) * other.vectors]),
                coupling=self.coupling + weight * other.coupling,
            )
        return DenseInnerProduct(self.dense() + weight * other.dense())

    def dense(self) -> FloatArray:
        matrix = self.apply(np.eye(len(self.curve)))
        return 0.5 * (matrix + matrix.T)

    def tangent_space(self, constraints: ConstraintDerivative, weights: FloatArray | None = None) -> TangentSpace:
        return IterativeTangentSpace(self, constraints, self.tolerances, weights)

    @cached_property
    def model(self) -> TwoLevel:
        """A function of the Laplacian along the components, and the coupling of whole components."""
        mesh, ell = self.curve.mesh, self.curve.edge_lengths
        starts = mesh.edge_offsets[:-1]
        # up to this ratio of a component's longest edge to its shortest, Fourier transforms are faster
        even = np.all(np.maximum.reduceat(ell, starts) <= 20.0 * np.minimum.reduceat(ell, starts))
        along = Circulants if even and mesh.all_closed else Resolvents
        return TwoLevel(mesh, along(mesh, ell, self.apply), self.coupling, _indicators(self.curve).T @ self.vectors)


def moebius_inner_product(
    curve: Curve, tolerances: Tolerances | None = None, theta: float = 0.5, leaf: int = 4
) -> CompressedInnerProduct:
    """J_C by the midpoint rule, as in `MoebiusMetric`, compressed."""
    blocks = BlockList.of(curve, theta, leaf)
    forms, order = PairForms(curve, blocks), blocks.tree.order
    near, far = (pair_kernels(curve, *pairs) for pairs in (blocks.near, blocks.middles))
    values, sums = forms.of_values(near.density, far.density)
    far_forms = [(RunningSum.of_values(curve, order), sums)]
    if not curve.mesh.all_closed:  # blocks of clusters of several components, some of them open
        far_forms.append((RunningSum.of_slopes(curve, order), forms.of_long_slopes(far.inverse)))
    return CompressedInnerProduct(
        curve,
        forms.of_slopes(near.inverse, far.inverse) + values + stiffness(curve, curve.mesh.arc_edges),
        tuple(far_forms),
        lumped_mass(curve)[:, None],
        forms.of_components(near.density, far.density),
        tolerances or Tolerances(),
    )


def fractional_inner_product(
    curve: Curve, tolerances: Tolerances | None = None, theta: float = 0.5, leaf: int = 4
) -> CompressedInnerProduct:
    """W^{3/2,2}, as in `FractionalMetric`, compressed."""
    blocks = BlockList.of(curve, theta, leaf)
    forms = PairForms(curve, blocks)
    near, far = (1.0 / arc_distance_of_pairs(curve, i, j, 0.5) ** 2 for i, j in (blocks.near, blocks.middles))
    n, indicators, weight = len(curve), _indicators(curve), mass(curve, 1.5)
    return CompressedInnerProduct(
        curve,
        forms.of_slopes(near, far) + weight,
        (),
        np.zeros((n, 0)),
        indicators.T @ weight @ indicators,
        tolerances or Tolerances(),
    )


_COMPRESSED: Mapping[type, Callable[[Curve, Tolerances | None, float, int], CompressedInnerProduct]] = {
    MoebiusMetric: moebius_inner_product,
    FractionalMetric: fractional_inner_product,
}


@dataclass(frozen=True)
class CompressedMetric:
    """A nonlocal metric by products in O(N log N), midpoint rule."""

    metric: Metric  # the dense one
    tolerances: Tolerances = field(default_factory=Tolerances)  # for what is solved with it
    theta: float = 0.5  # separation parameter of blocks
    leaf: int = 4  # edges up to which clusters are not halved
    most_vertices = MAX_VERTICES

    @property
    def name(self) -> str:
        return self.metric.name

    @property
    def description(self) -> str:
        return self.metric.description

    @property
    def extends_penalty(self) -> bool:
        return self.metric.extends_penalty

    @property
    def rule(self) -> Rule | None:
        return self.metric.rule

    def with_rule(self, rule: Rule) -> "CompressedMetric":
        """The metric itself; OptionError if another rule is asked for: there is none."""
        if self.rule is not None and rule != MIDPOINT:
            raise OptionError("metrics for so many vertices use one Gauss point per edge; leave quadrature_points out")
        return self

    def at(self, curve: Curve) -> InnerProduct:
        return _COMPRESSED[type(self.metric)](curve, self.tolerances, self.theta, self.leaf)


def compressed(metric: Metric, tolerances: Tolerances) -> Metric:
    """A metric in its form for many vertices: local ones are already sparse."""
    return CompressedMetric(metric, tolerances) if type(metric) in _COMPRESSED else metric


def block_count(curve: Curve) -> int:
    """Number of blocks of these inner products."""
    return len(BlockList.of(curve, CompressedMetric.theta, CompressedMetric.leaf).first)


def _indicators(curve: Curve) -> sp.csr_array:
    """Which vertices belong to which component, as 0 and 1; shape (n, components)."""
    n = len(curve)
    return sp.csr_array((np.ones(n), (np.arange(n), curve.mesh.component)))
