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

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from scipy.spatial.distance import cdist

from ..base import BoolArray, FloatArray, OptionError, dot
from ..curve import Curve, arc_positions, periods
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
        a = dot(self._x, self._tau_x)[:, None] - self._tau_x @ self._y.T
        a[self._tile.excluded] = 0.0
        return np.asarray(a)

    @cached_property
    def b(self) -> FloatArray:
        b = self._x @ self._tau_y.T - dot(self._y, self._tau_y)
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


@dataclass(frozen=True)
class ArcDensity:
    """F = 1/r² − 1/ϱ², eq. (12) of [RS21], 1/r² between components; ∬ F is 4 for a circle, so nothing is added."""

    constant = 0.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        inverse = 1.0 / pairs.rho  # 0 between components; powers of a complex infinity are no numbers
        return 1.0 / pairs.r2 - inverse * inverse

    def derivative(self, pairs: PointPairs) -> Partials:
        inverse = 1.0 / pairs.rho
        return Partials(r2=-1.0 / (pairs.r2 * pairs.r2), rho=2.0 * inverse * inverse * inverse)


@dataclass(frozen=True)
class IshizekiNagasawaDensity:
    """F = (1 + ⟨τ_x, τ_y⟩ − 2 ⟨d, τ_x⟩⟨d, τ_y⟩/r²)/r² = (1 − cos α)/r² ≥ 0, so E = 4 + ∬ F on a closed curve."""

    constant = 4.0
    scale_exponent = -2.0
    moebius_invariant = True

    def value(self, pairs: PointPairs) -> FloatArray:
        s = 1.0 / pairs.r2
        return s * (1.0 + pairs.c - 2.0 * pairs.a * pairs.b * s)

    def derivative(self, pairs: PointPairs) -> Partials:
        s = 1.0 / pairs.r2
        s2 = s * s
        return Partials(
            r2=s2 * (4.0 * pairs.a * pairs.b * s - 1.0 - pairs.c), a=-2.0 * pairs.b * s2, b=-2.0 * pairs.a * s2, c=s
        )


@dataclass(frozen=True)
class TangentPointDensity:
    """F = ½ (|d ∧ τ_x|^α + |d ∧ τ_y|^α)/r^β, with |d ∧ τ|² = r² − ⟨d, τ⟩².

    OptionError unless α ≥ 2 and α + 2 ≤ β < 2 α + 1: strong enough to keep strands apart, finite for smooth curves.
    """

    alpha: float = 3.0
    beta: float = 6.0

    constant = 0.0

    @property
    def scale_exponent(self) -> float:
        return self.alpha - self.beta

    def __post_init__(self) -> None:
        if not self.alpha >= 2.0:
            raise OptionError(f"alpha is {self.alpha}; it must be 2 or more")
        if not self.alpha + 2.0 <= self.beta < 2.0 * self.alpha + 1.0:
            raise OptionError(f"beta is {self.beta}; it must be from alpha + 2 to below 2 alpha + 1")

    def value(self, pairs: PointPairs) -> FloatArray:
        power = 0.5 * self.alpha
        heights = _squared_height(pairs, pairs.a) ** power + _squared_height(pairs, pairs.b) ** power
        return np.asarray(0.5 * heights * pairs.r2 ** (-0.5 * self.beta))

    def derivative(self, pairs: PointPairs) -> Partials:
        power, decay = 0.5 * self.alpha, pairs.r2 ** (-0.5 * self.beta)
        height_a, height_b = _squared_height(pairs, pairs.a), _squared_height(pairs, pairs.b)
        slope_a = (0.5 * power) * height_a ** (power - 1.0) * decay
        slope_b = (0.5 * power) * height_b ** (power - 1.0) * decay
        heights = height_a**power + height_b**power
        return Partials(
            r2=slope_a + slope_b - (0.25 * self.beta) * heights * decay / pairs.r2,
            a=-2.0 * pairs.a * slope_a,
            b=-2.0 * pairs.b * slope_b,
        )


def _squared_height(pairs: PointPairs, along: FloatArray) -> FloatArray:
    """|d ∧ τ|², which rounding must not make negative; where it is 0, so is its derivative."""
    squared = pairs.r2 - along * along
    return np.where(squared.real > 0.0, squared, 0.0)
