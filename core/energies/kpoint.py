"""Energies ∬ F by k-point quadrature on pairs of edges, eq. (40) of [RS21].

E = constant · components + Σ W_IJ over ordered pairs of edges with disjoint closures (arcs count as in `components`),
W_IJ = ℓ_I ℓ_J Σ_ij ω_i ω_j F(x_I(t_i), x_J(t_j)),  x_I(t) = (1 − t) P(I↓) + t P(I↑).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arguments import checked_fields
from ..curve import Curve
from ..curve.distances import points_at
from ..curve.tiles import Tile, pair_tiles
from ..quadrature import Rule
from ..types import FloatArray
from .components import ComponentShares
from .density import Density, PointPairs, PointSet
from .energy import is_moebius_invariant
from .kpoint_sums import KPointSums


@checked_fields
@dataclass(frozen=True)
class KPointEnergy:
    """The energy of a density by a quadrature rule.

    Parameters
    ----------
    name, description
        As shown to users.
    density
        F.
    rule
        Its points on every edge.
    arc_derivative
        Whether the derivative includes that of ϱ.  If it does not, it is right only in directions that keep every
        edge length, so for gradients projected onto that constraint (footnote 5 of [RS21]).
    """

    name: str
    description: str
    density: Density
    rule: Rule
    arc_derivative: bool = True
    contains_midpoint_pairs = False

    @property
    def scale_exponent(self) -> float:
        """s of E(λ P) = λˢ E(P): the density's, and 2 for the double integral."""
        return self.density.scale_exponent + 2.0

    @property
    def moebius_invariant(self) -> bool:
        """Whether the density says so."""
        return is_moebius_invariant(self.density)

    def value(self, curve: Curve) -> float:
        """Energy of the curve."""
        sums = KPointSums(curve)
        total = 0.0
        for tile, x, y, area in self._pairs(curve, sums):
            total += float(np.vdot(area, self.density.value(PointPairs(x, y, sums.arcs, tile))))
        return self._energy(curve, total)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """Energy and its derivative with respect to the vertices, shape (n, m)."""
        sums = KPointSums(curve)
        total = 0.0
        for tile, x, y, area in self._pairs(curve, sums):
            total += sums.add(tile, x, y, area, self.density)
        of_components = self.density.constant * ComponentShares(curve).derivative()
        return self._energy(curve, total), 2.0 * sums.at_vertices(self.arc_derivative) + of_components

    def _energy(self, curve: Curve, total: float) -> float:
        """The energy from the sum over unordered pairs."""
        return self.density.constant * ComponentShares(curve).value() + 2.0 * total

    def _pairs(self, curve: Curve, sums: KPointSums) -> Iterator[tuple[Tile, PointSet, PointSet, FloatArray]]:
        """All pairs of quadrature points, with their weights ω_i ω_j ℓ_I ℓ_J, 0 for edges with a common vertex."""
        centre = curve.vertices.mean(axis=0)
        sets = [PointSet(t, points_at(curve, t) - centre, sums.tau) for t in self.rule.points]
        weighted = list(zip(sets, self.rule.weights, strict=True))
        for tile in pair_tiles(curve.mesh):
            area = np.multiply.outer(curve.edge_lengths[tile.rows], curve.edge_lengths[tile.columns])
            area[tile.excluded] = 0.0
            for x, omega_x in weighted:
                for y, omega_y in weighted:
                    yield tile, x, y, area * (omega_x * omega_y)
