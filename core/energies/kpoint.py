"""Energies ∬ F by k-point quadrature on pairs of edges, eq. (40) of [RS21].

E = constant · components + Σ W_IJ over ordered pairs of edges with disjoint closures (arcs count as in `components`),
W_IJ = ℓ_I ℓ_J Σ_ij ω_i ω_j F(x_I(t_i), x_J(t_j)),  x_I(t) = (1 − t) P(I↓) + t P(I↑).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..base import FloatArray, checked, checked_fields, dot
from ..curve import Curve, points_at
from .components import ComponentShares
from .density import ArcDensity, Arcs, Density, IshizekiNagasawaDensity, PointPairs, PointSet, TangentPointDensity
from .edge_pairs import SteppedCurve, Tile, change, pair_tiles
from .energy import is_moebius_invariant
from .quadrature import ENDS, MIDPOINT, TAIL, Rule


@checked_fields
@dataclass(frozen=True)
class KPointEnergy:
    """The energy of a density F by a quadrature rule."""

    name: str  #: as shown to users, like the description
    description: str
    density: Density  #: F, a function of pairs of points of the curve
    rule: Rule  #: the quadrature points on every edge
    contains_midpoint_pairs = False

    @property
    def scale_exponent(self) -> float:
        """s of E(λ P) = λˢ E(P): the density's, and 2 for the double integral."""
        return self.density.scale_exponent + 2.0

    @property
    def moebius_invariant(self) -> bool:
        """Whether the density is Möbius invariant."""
        return is_moebius_invariant(self.density)

    def value(self, curve: Curve) -> float:
        arcs, total = Arcs(curve), 0.0
        for tile, x, y, area in self._pairs(curve):
            total += float(np.vdot(area, self.density.value(PointPairs(x, y, arcs, tile))))
        return self._energy(curve, total)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        total, derivative = self._sum_and_derivative(curve)
        return self._energy(curve, total), derivative

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for ``v`` of shape (n, m), by a complex step of the derivative; shape (n, m).

        Where two arcs are equally long ϱ is their mean.
        """
        return change(self._sum_and_derivative(SteppedCurve(curve, v))[1])

    def _sum_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The sum over unordered pairs, and the energy's derivative, also after a complex step."""
        ell, tau = curve.edge_lengths, curve.edge_vectors / curve.edge_lengths[:, None]
        arcs = Arcs(curve)
        by_tail, by_head, by_tau = (np.zeros_like(tau) for _ in range(3))
        by_length, total = np.zeros_like(ell), 0.0
        for tile, x, y, area in self._pairs(curve):
            rows, columns, pairs = tile.rows, tile.columns, PointPairs(x, y, arcs, tile)
            weighted = area * self.density.value(pairs)
            total += float(weighted.sum().real)
            by_length[rows] += weighted.sum(axis=1) / ell[rows]
            by_length[columns] += weighted.sum(axis=0) / ell[columns]
            # with d = x − y, ∂F/∂d is 2 F_{r²} d + F_a τ_x + F_b τ_y, ∂F/∂τ_x is F_a d + F_c τ_y, likewise ∂F/∂τ_y
            partials = self.density.derivative(pairs)
            here, there, tau_x, tau_y = x.x[rows], y.x[columns], tau[rows], tau[columns]
            force_x, force_y = _differences((2.0 * area) * partials.r2, here, there)  # Σ_J and Σ_I of ∂F/∂d
            if partials.a is not None:
                weights = area * partials.a
                by_tau[rows] += _differences(weights, here, there)[0]
                force_x += weights.sum(axis=1)[:, None] * tau_x
                force_y += weights.T @ tau_x
            if partials.b is not None:
                weights = area * partials.b
                by_tau[columns] += _differences(weights, here, there)[1]
                force_x += weights @ tau_y
                force_y += weights.sum(axis=0)[:, None] * tau_y
            if partials.c is not None:
                weights = area * partials.c
                by_tau[rows] += weights @ tau_y
                by_tau[columns] += weights.T @ tau_x
            if partials.rho is not None:
                arcs.add(tile, x.t, y.t, area * partials.rho)
            for edges, t, force in ((rows, x.t, force_x), (columns, y.t, -force_y)):
                by_tail[edges] += (1.0 - t) * force
                by_head[edges] += t * force
        # ∂τ/∂e = (1 − τ τᵀ)/ℓ
        across = by_tau - dot(by_tau, tau)[:, None] * tau
        by_edge = (by_length + arcs.by_length())[:, None] * tau + across / ell[:, None]
        derivative = 2.0 * curve.mesh.scatter(by_tail - by_edge, by_head + by_edge)
        return total, derivative + self.density.constant * ComponentShares(curve).derivative()

    def _energy(self, curve: Curve, total: float) -> float:
        """The energy from the sum over unordered pairs."""
        return self.density.constant * ComponentShares(curve).value() + 2.0 * total

    def _pairs(self, curve: Curve) -> Iterator[tuple[Tile, PointSet, PointSet, FloatArray]]:
        """All pairs of quadrature points, with their weights ω_i ω_j ℓ_I ℓ_J, 0 for edges with a common vertex."""
        center, tau = curve.vertices.mean(axis=0), curve.edge_vectors / curve.edge_lengths[:, None]
        sets = [PointSet(t, points_at(curve, t) - center, tau) for t in self.rule.points]
        weighted = list(zip(sets, self.rule.weights, strict=True))
        for tile in pair_tiles(curve.mesh):
            area = np.multiply.outer(curve.edge_lengths[tile.rows], curve.edge_lengths[tile.columns])
            area[tile.excluded] = 0.0
            for x, omega_x in weighted:
                for y, omega_y in weighted:
                    yield tile, x, y, area * (omega_x * omega_y)


def _differences(weights: FloatArray, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Σ_J w_IJ (x_I − y_J) and Σ_I w_IJ (x_I − y_J)."""
    by_row = weights.sum(axis=1)[:, None] * x - weights @ y
    by_column = weights.T @ x - weights.sum(axis=0)[:, None] * y
    return by_row, by_column


VERTEX_ENERGY, EDGE_ENERGY = (
    KPointEnergy(
        name=name,
        description=f"{name} energy of Kusner and Sullivan: 1/r² − 1/ϱ² at the edges' {points}",
        density=ArcDensity(),
        rule=rule,
    )
    for name, points, rule in (("vertex", "tails", TAIL), ("edge", "midpoints", MIDPOINT))
)
"""One point per edge: R. Kusner and J. Sullivan, Möbius energies for knots and links (1997); Section 6.1.1 of [RS21].

On equilateral polygons the vertex energy Γ-converges to the Möbius energy: S. Scholtes, Discrete Möbius energy (2014).
"""


@checked
def moebius_kpoint(points: int) -> KPointEnergy:
    """The Möbius energy by the Gauss rule with ``points`` points per edge, eq. (40); OptionError below 1."""
    return KPointEnergy(
        name=f"moebius-k{points}",
        description=f"Möbius energy without arc distances, {points} Gauss points per edge",
        density=IshizekiNagasawaDensity(),
        rule=Rule.gauss(points),
    )


TANGENT_POINT_ENERGY = KPointEnergy(
    name="tangent-point",
    description="tangent-point energy with exponents 3 and 6, at the edges' end points",
    density=TangentPointDensity(),
    rule=ENDS,
)
