"""The Möbius energy without arc distances, by the midpoint rule (Section 6.1.1 of [RS21]).

E = 4·components + Σ W_IJ over ordered pairs of edges with disjoint closures (an arc counts as in `components`), with

    W_IJ = (ℓ_I ℓ_J + ⟨e_I, e_J⟩) s − 2 ⟨Δ, e_I⟩ ⟨Δ, e_J⟩ s²,   Δ = m_I − m_J,  s = 1/|Δ|²,

Ishizeki and Nagasawa's density (1 − cos α)/r² at the midpoints.  A round circle has energy 4.
"""

from dataclasses import dataclass, field

import numpy as np

from ..arguments import checked_fields
from ..curve import Curve
from ..quadrature import MIDPOINT
from ..types import FloatArray, IntArray
from .components import ComponentShares
from .edge_pairs import ROWS_TIMES_COLUMNS, EdgePairIndices, change, pair_tiles, row_tiles
from .moebius_hessian import hessian
from .moebius_pairs import Edges, Pairs, PartnerSums

CONSTANT = 4.0  # of a closed component


@checked_fields
@dataclass(frozen=True, eq=False)
class MoebiusEnergy:
    """The plain midpoint sum, reported as ``moebius``, without pairs of edges that something else stands for."""

    without: EdgePairIndices | None = field(default=None, repr=False)
    name = "moebius"
    rule = MIDPOINT
    scale_exponent = 0.0
    moebius_invariant = True
    contains_midpoint_pairs = True
    description = "Möbius energy without arc distances, midpoint rule (Ishizeki–Nagasawa density)"

    def leaving_out(self, pairs: EdgePairIndices) -> "MoebiusEnergy":
        """The same sum without some pairs of edges."""
        return MoebiusEnergy(pairs)

    def value(self, curve: Curve) -> float:
        """Energy E of the curve; 4 for a regular polygon."""
        edges = Edges.of(curve)
        tiles = pair_tiles(curve.mesh, self.without)
        return energy_of_pairs(curve, sum(Pairs.of(edges, tile).energy() for tile in tiles))

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """Energy and its derivative with respect to the vertices, shape (n, m)."""
        edges = Edges.of(curve)
        total, sums = 0.0, PartnerSums.zeros(edges.vectors)
        for tile in pair_tiles(curve.mesh, self.without):
            pairs = Pairs.of(edges, tile)
            total += pairs.energy()
            sums.add(tile.rows, tile.columns, pairs.coefficients(), edges.vectors)
        at_vertices = sums.derivatives(edges.vectors).at_vertices(curve.mesh, edges.tau)
        derivative = 2.0 * at_vertices + CONSTANT * ComponentShares(curve).derivative()
        return energy_of_pairs(curve, total), derivative

    def row_energies(self, curve: Curve, rows: IntArray) -> FloatArray:
        """Σ_J W_IJ for some edges I, shape (rows,): over all edges these add up to E without the components' shares."""
        edges = Edges.of(curve)
        return np.concatenate(
            [Pairs.of(edges, tile).row_energies() for tile in row_tiles(curve.mesh, rows, self.without)]
        )

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative D²E, symmetric, shape (n·m, n·m), in the order of ``vertices.ravel()``."""
        matrix = hessian(curve, self.without)
        columns, shares = ComponentShares(curve).hessian_columns()
        matrix[:, columns] += CONSTANT * shares
        return matrix

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
        edges = Edges.of(curve, v)
        sums = PartnerSums.zeros(edges.vectors)
        for tile in pair_tiles(curve.mesh, self.without, ROWS_TIMES_COLUMNS // 2):
            sums.add(tile.rows, tile.columns, Pairs.of(edges, tile).coefficients(), edges.vectors)
        at_vertices = sums.derivatives(edges.vectors).at_vertices(curve.mesh, edges.tau)
        return 2.0 * change(at_vertices) + CONSTANT * ComponentShares(curve).second_derivative(v)


def energy_of_pairs(curve: Curve, pairs: float) -> float:
    """The energy from the sum over unordered pairs."""
    return CONSTANT * ComponentShares(curve).value() + 2.0 * pairs


def moebius_by_length(curve: Curve) -> FloatArray:
    """(Σ_J W_IJ)/ℓ_I, energy per length of each edge, (edges,), in 1/length; without the components' shares."""
    return np.asarray(MoebiusEnergy().row_energies(curve, np.arange(curve.mesh.edges)) / curve.edge_lengths)
