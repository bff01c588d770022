"""Densities of energies ∬ F over pairs of points of a curve, and what they may depend on.

A density that is invariant under rigid motions is a function of five numbers of a pair of points x and y with unit
tangents τ_x and τ_y: of r² = |d|², a = ⟨d, τ_x⟩, b = ⟨d, τ_y⟩ with d = x − y, of c = ⟨τ_x, τ_y⟩, and of the
distance ϱ along the curve.  A new density states its value and its derivatives by those it uses; quadrature and
chain rule (`kpoint`) are the same for all.
"""

from functools import cached_property
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from scipy.spatial.distance import cdist

from ..curve.tiles import Tile
from ..types import FloatArray
from .arcs import Arcs


class PointSet(NamedTuple):
    """One quadrature point per edge."""

    t: float  # parameter on the edge, from 0 at its tail to 1 at its head
    x: FloatArray  # the points, taken from the curve's center so that their products keep their digits; (edges, m)
    tau: FloatArray  # unit tangents, (edges, m)


class PointPairs:
    """The pairs (x, y) of a tile, x on the edges of its rows and y on those of its columns; computed on demand.

    All arrays have the shape (rows, columns).  Pairs that do not count have finite numbers without meaning.
    """

    def __init__(self, x: PointSet, y: PointSet, arcs: Arcs, tile: Tile) -> None:
        self._x, self._y, self._arcs, self._tile = x, y, arcs, tile

    @cached_property
    def r2(self) -> FloatArray:
        """|x − y|², from differences: strands may be close."""
        r2 = np.asarray(cdist(self._x.x[self._tile.rows], self._y.x[self._tile.columns], "sqeuclidean"))
        r2[self._tile.excluded] = 1.0
        return r2

    @cached_property
    def a(self) -> FloatArray:
        """⟨x − y, τ_x⟩."""
        x, tau = self._x.x[self._tile.rows], self._x.tau[self._tile.rows]
        a = np.einsum("ij,ij->i", x, tau)[:, None] - tau @ self._y.x[self._tile.columns].T
        a[self._tile.excluded] = 0.0
        return np.asarray(a)

    @cached_property
    def b(self) -> FloatArray:
        """⟨x − y, τ_y⟩."""
        y, tau = self._y.x[self._tile.columns], self._y.tau[self._tile.columns]
        b = self._x.x[self._tile.rows] @ tau.T - np.einsum("ij,ij->i", y, tau)
        b[self._tile.excluded] = 0.0
        return np.asarray(b)

    @cached_property
    def c(self) -> FloatArray:
        """⟨τ_x, τ_y⟩."""
        return np.asarray(self._x.tau[self._tile.rows] @ self._y.tau[self._tile.columns].T)

    @cached_property
    def rho(self) -> FloatArray:
        """Distance ϱ along the curve; inf between components."""
        return self._arcs.distances(self._tile, self._x.t, self._y.t)


class Partials(NamedTuple):
    """Derivatives of a density by the numbers it uses, each of shape (rows, columns); None for 0."""

    r2: FloatArray
    a: FloatArray | None = None
    b: FloatArray | None = None
    c: FloatArray | None = None
    rho: FloatArray | None = None


@runtime_checkable
class Density(Protocol):
    """F(x, y), unchanged if x and y change places: (a, b) becomes (−b, −a).

    Where ϱ is infinite, F must be finite and its derivative by ϱ zero.
    """

    @property
    def constant(self) -> float:
        """What the energy has besides the integral, per closed component; arcs have shares of it (`components`)."""

    @property
    def scale_exponent(self) -> float:
        """s of F(λ x, λ y) = λˢ F(x, y)."""

    def value(self, pairs: PointPairs) -> FloatArray:
        """F of every pair, shape (rows, columns)."""

    def derivative(self, pairs: PointPairs) -> Partials:
        """The derivatives of F."""
