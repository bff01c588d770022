"""Densities of energies ∬ F over pairs of points of a curve, and what they may depend on.

A density that is invariant under rigid motions is a function of five numbers of a pair of points x and y with unit
tangents τ_x and τ_y: of r² = |d|², a = ⟨d, τ_x⟩, b = ⟨d, τ_y⟩ with d = x − y, of c = ⟨τ_x, τ_y⟩, and of the
distance ϱ along the curve.  A new density states its value and its derivatives by those it uses; quadrature and
chain rule (`kpoint`) are the same for all.

ϱ of points on the edges I < J of one component is the shorter of the two arcs between them; where a component is open
the other one counts as infinitely long.  Its derivative by the length of an edge is 1 where the edge lies on that arc,
a fraction for I and J themselves, else 0; at the kink, where both arcs are equally long, the mean of the two.  Summed
over N² pairs with weights this needs only the weights' sums over rows and columns and running sums along the curve.
"""

from functools import cached_property
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from scipy.spatial.distance import cdist

from ..base.types import BoolArray, FloatArray
from ..curve import Curve
from ..curve.distances import arc_positions, periods
from .edge_pairs import Tile, half_changes


class Arcs:
    """Arc lengths of one curve; collects Σ g_IJ ∂ϱ_IJ/∂ℓ_K for all edges K, with weights g."""

    def __init__(self, curve: Curve) -> None:
        mesh, ell = curve.mesh, curve.edge_lengths
        self.ell = ell
        self.component = mesh.edge_component
        self.start = arc_positions(curve, 0.0)
        self.total = periods(curve)
        self._at_edges = np.zeros_like(ell)
        self._steps = np.zeros(len(ell) + 1, ell.dtype)  # differences, from edge to edge, of what all of an arc get
        self._around = np.zeros(len(self.total), ell.dtype)  # the amounts that all edges of a component get

    def distances(self, tile: Tile, t_row: float, t_column: float) -> FloatArray:
        """ϱ between points at ``t_row`` of the tile's rows and ``t_column`` of its columns; inf between components."""
        gap, together = self._gaps(tile, t_row, t_column)
        around = self.total[self.component[tile.rows], None] - gap
        rho = np.where(together, np.minimum(gap, around), np.inf)
        if np.iscomplexobj(gap):  # of two complex numbers with one real part neither is the right minimum
            kink = together & (self.shares(tile, t_row, t_column) == 0.5)
            rho[kink] = 0.5 * (gap + around)[kink]
        rho[tile.excluded] = 1.0
        return rho

    def shares(self, tile: Tile, t_row: float, t_column: float) -> FloatArray:
        """1 where the arc from row to column in the direction of the curve is the shorter one, 0 where the other is."""
        gap, _ = self._gaps(tile, t_row, t_column)
        total = self.total[self.component[tile.rows], None]
        excess = 1.0 - 2.0 * gap.real / total.real
        equal = np.abs(excess) < 1e-12  # relative to the component, so much by rounding
        return np.where(equal, 0.5, np.where(excess > 0.0, 1.0, 0.0))

    def _gaps(self, tile: Tile, t_row: float, t_column: float) -> tuple[FloatArray, BoolArray]:
        """Arc length from row to column in the direction of the curve, and whether they are on one component."""
        rows, columns = tile.rows, tile.columns
        position = self.start[columns] + t_column * self.ell[columns]
        gap = position - (self.start[rows] + t_row * self.ell[rows])[:, None]
        return gap, self.component[rows, None] == self.component[columns]

    def add(self, tile: Tile, t_row: float, t_column: float, weights: FloatArray) -> None:
        """Add pairs I < J of a tile with weights, (rows, columns), 0 for pairs on different components."""
        direct = weights * self.shares(tile, t_row, t_column)
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
        np.add.at(self._around, self.component[rows], around_rows)
        self._steps[rows] -= around_rows
        self._steps[after_columns] += around_columns
        self._at_edges[rows] += t_row * around_rows
        self._at_edges[columns] += (1.0 - t_column) * around_columns

    def by_length(self) -> FloatArray:
        """What has been collected, shape (edges,)."""
        return np.asarray(self._at_edges + np.cumsum(self._steps)[:-1] + self._around[self.component])


class PointSet(NamedTuple):
    """One quadrature point per edge."""

    t: float  # parameter on the edge, from 0 at its tail to 1 at its head
    x: FloatArray  # the points, taken from the curve's center so that their products keep their digits; (edges, m)
    tau: FloatArray  # unit tangents, (edges, m)


class PointPairs:
    """The pairs (x, y) of a tile, x on the edges of its rows and y on those of its columns; computed on demand.

    These are r², a = ⟨x − y, τ_x⟩, b = ⟨x − y, τ_y⟩, c = ⟨τ_x, τ_y⟩ and ϱ.  All arrays have the shape (rows, columns).
    Pairs that do not count have finite numbers without meaning.
    """

    def __init__(self, x: PointSet, y: PointSet, arcs: Arcs, tile: Tile) -> None:
        self._arcs, self._tile, self._places = arcs, tile, (x.t, y.t)
        self._x, self._tau_x = x.x[tile.rows], x.tau[tile.rows]
        self._y, self._tau_y = y.x[tile.columns], y.tau[tile.columns]

    @cached_property
    def r2(self) -> FloatArray:
        """|x − y|², from differences: strands may be close."""
        r2 = np.asarray(cdist(self._x.real, self._y.real, "sqeuclidean"))
        if np.iscomplexobj(self._x):
            r2 = r2 + 2j * half_changes(self._x, self._y)
        r2[self._tile.excluded] = 1.0
        return r2

    @cached_property
    def a(self) -> FloatArray:
        a = np.einsum("ij,ij->i", self._x, self._tau_x)[:, None] - self._tau_x @ self._y.T
        a[self._tile.excluded] = 0.0
        return np.asarray(a)

    @cached_property
    def b(self) -> FloatArray:
        b = self._x @ self._tau_y.T - np.einsum("ij,ij->i", self._y, self._tau_y)
        b[self._tile.excluded] = 0.0
        return np.asarray(b)

    @cached_property
    def c(self) -> FloatArray:
        return np.asarray(self._tau_x @ self._tau_y.T)

    @cached_property
    def rho(self) -> FloatArray:
        """Distance ϱ along the curve; inf between components."""
        return self._arcs.distances(self._tile, *self._places)


class Partials(NamedTuple):
    """Derivatives of a density by the numbers it uses, each of shape (rows, columns); None for 0."""

    r2: FloatArray
    a: FloatArray | None = None
    b: FloatArray | None = None
    c: FloatArray | None = None
    rho: FloatArray | None = None


@runtime_checkable
class Density(Protocol):
    """F(x, y) = F(y, x): (a, b) becomes (−b, −a).  Where ϱ is infinite, F is finite and its derivative by ϱ zero.

    Second derivatives are by complex steps: both methods must be analytic in the numbers of a pair, ϱ = inf + 0i too.
    """

    @property
    def constant(self) -> float:
        """The energy besides the integral, per closed component; arcs have shares of it (`components`)."""

    @property
    def scale_exponent(self) -> float:
        """s of F(λ x, λ y) = λˢ F(x, y)."""

    def value(self, pairs: PointPairs) -> FloatArray:
        """F of every pair, shape (rows, columns)."""

    def derivative(self, pairs: PointPairs) -> Partials:
        """The derivatives of F."""
