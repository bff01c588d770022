"""Distances along the curve between quadrature points, and the derivatives of functions of them by edge lengths.

ϱ of points on the edges I < J of one component is the shorter of the two arcs between them; where a component is open
the other one counts as infinitely long.  Its derivative by the length of an edge is 1 where the edge lies on that arc,
a fraction for I and J themselves, else 0; at the kink, where both arcs are equally long, the mean of the two.  Summed
over N² pairs with weights this needs only the weights' sums over rows and columns and running sums along the curve.
"""

import numpy as np

from ..curve import Curve
from ..curve.distances import arc_positions, periods
from ..curve.tiles import Tile
from ..types import BoolArray, FloatArray

KINK = 1e-12  # difference of the two arcs, relative to the component, below which they count as equal


class Arcs:
    """Arc lengths of one curve."""

    def __init__(self, curve: Curve) -> None:
        mesh, ell = curve.mesh, curve.edge_lengths
        self.ell = ell
        self.component = mesh.edge_component
        self.start = arc_positions(curve, 0.0)
        self.total = periods(curve)

    def distances(self, tile: Tile, t_row: float, t_column: float) -> FloatArray:
        """ϱ between points at ``t_row`` of the tile's rows and ``t_column`` of its columns; inf between components."""
        gap, together = self._gaps(tile, t_row, t_column)
        total = self.total[self.component[tile.rows], None]
        rho = np.where(together, np.minimum(gap, total - gap), np.inf)
        rho[tile.excluded] = 1.0
        return rho

    def shares(self, tile: Tile, t_row: float, t_column: float) -> FloatArray:
        """1 where the arc from row to column in the direction of the curve is the shorter one, 0 where the other is."""
        gap, _ = self._gaps(tile, t_row, t_column)
        total = self.total[self.component[tile.rows], None]
        excess = 1.0 - 2.0 * gap / total
        return np.where(np.abs(excess) < KINK, 0.5, np.where(excess > 0.0, 1.0, 0.0))

    def _gaps(self, tile: Tile, t_row: float, t_column: float) -> tuple[FloatArray, BoolArray]:
        """Arc length from row to column in the direction of the curve, and whether they are on one component."""
        rows, columns = tile.rows, tile.columns
        position = self.start[columns] + t_column * self.ell[columns]
        gap = position - (self.start[rows] + t_row * self.ell[rows])[:, None]
        return gap, self.component[rows, None] == self.component[columns]


class ArcDerivative:
    """Collects Σ g_IJ ∂ϱ_IJ/∂ℓ_K for all edges K; weights g are 0 for pairs on different components."""

    def __init__(self, arcs: Arcs) -> None:
        self._arcs = arcs
        n = len(arcs.ell)
        self._at_edges = np.zeros(n)
        self._steps = np.zeros(n + 1)  # differences, from edge to edge, of what all edges of an arc get
        self._around = np.zeros(len(arcs.total))  # what all edges of a component get

    def add(self, tile: Tile, t_row: float, t_column: float, weights: FloatArray) -> None:
        """Add the pairs of a tile; ``weights`` has shape (rows, columns), and every row index I < J."""
        direct = weights * self._arcs.shares(tile, t_row, t_column)
        direct_rows, direct_columns = direct.sum(axis=1), direct.sum(axis=0)
        around_rows, around_columns = weights.sum(axis=1) - direct_rows, weights.sum(axis=0) - direct_columns
        rows, columns = tile.rows, tile.columns
        after_rows = slice(rows.start + 1, rows.stop + 1)
        after_columns = slice(columns.start + 1, columns.stop + 1)
        # the direct arc has the last part of I, all edges between and the first part of J
        self._steps[after_rows] += direct_rows
        self._steps[columns] -= direct_columns
        self._at_edges[rows] += (1.0 - t_row) * direct_rows
        self._at_edges[columns] += t_column * direct_columns
        # the other arc has the rest: all edges but I … J, the first part of I and the last part of J
        np.add.at(self._around, self._arcs.component[rows], around_rows)
        self._steps[rows] -= around_rows
        self._steps[after_columns] += around_columns
        self._at_edges[rows] += t_row * around_rows
        self._at_edges[columns] += (1.0 - t_column) * around_columns

    def by_length(self) -> FloatArray:
        """The sums, shape (edges,)."""
        return np.asarray(self._at_edges + np.cumsum(self._steps)[:-1] + self._around[self._arcs.component])
