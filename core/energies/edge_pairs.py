"""Pairs of straight edges in three vectors, Δ between the midpoints and the edges e and f, and their chain rule."""

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from ..curve import Curve, Mesh
from ..types import BoolArray, FloatArray, IntArray, frozen

Combination = tuple[float, float, float]
DELTA, E, F = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

# how the tail and head of the first edge and of the second (rows) enter Δ, e and f (columns)
_CORNERS = np.array([[0.5, -1.0, 0.0], [0.5, 1.0, 0.0], [-0.5, 0.0, -1.0], [-0.5, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Jet:
    """A quantity of k pairs of edges, its derivatives by c local variables, and their change along r directions.

    With r = c and the coordinate directions the change of the first derivatives is the matrix of second ones;
    with r = 1 it is the product of that matrix with a vector; r = 0 asks for first derivatives only.
    """

    value: FloatArray  # (k,)
    first: FloatArray  # first derivatives, (k, c)
    along: FloatArray  # derivatives along the directions, (k, r)
    second: FloatArray  # derivatives of ``first`` along the directions, (k, c, r), or (1, c, r) if they are constant

    def __add__(self, other: "Jet") -> "Jet":
        return Jet(
            self.value + other.value, self.first + other.first, self.along + other.along, self.second + other.second
        )

    def __sub__(self, other: "Jet") -> "Jet":
        return self + other.scaled(-1.0)

    def __mul__(self, other: "Jet") -> "Jet":
        f, g = self.value[:, None], other.value[:, None]
        second = f[:, :, None] * other.second
        second += g[:, :, None] * self.second
        second += self.first[:, :, None] * other.along[:, None, :]
        second += other.first[:, :, None] * self.along[:, None, :]
        first, along = f * other.first + g * self.first, f * other.along + g * self.along
        return Jet(self.value * other.value, first, along, second)

    def scaled(self, factor: float) -> "Jet":
        return Jet(factor * self.value, factor * self.first, factor * self.along, factor * self.second)

    def where(self, kept: BoolArray) -> "Jet":
        """The quantity for some pairs, shape (k,), and 0 for the others, even if it is infinite there."""
        value, first = np.where(kept, self.value, 0.0), np.where(kept[:, None], self.first, 0.0)
        along, second = np.where(kept[:, None], self.along, 0.0), np.where(kept[:, None, None], self.second, 0.0)
        return Jet(value, first, along, second)

    def compose(self, value: FloatArray, slope: FloatArray, curvature: FloatArray) -> "Jet":
        """A function of the quantity, by its values and first and second derivatives there, each (k,)."""
        slope = slope[:, None]
        second = slope[:, :, None] * self.second
        second += (curvature[:, None] * self.first)[:, :, None] * self.along[:, None, :]
        return Jet(value, slope * self.first, slope * self.along, second)

    def sqrt(self) -> "Jet":
        root = np.sqrt(self.value)
        return self.compose(root, 0.5 / root, -0.25 / (root * self.value))

    def reciprocal(self) -> "Jet":
        inverse = 1.0 / self.value
        return self.compose(inverse, -(inverse**2), 2.0 * inverse**3)

    def log(self) -> "Jet":
        inverse = 1.0 / self.value
        return self.compose(np.log(self.value), inverse, -(inverse**2))


class EdgePairs(NamedTuple):
    """k pairs of edges: x(s) = x_mid + (s − ½) e, y(t) = y_mid + (t − ½) f, Δ = x_mid − y_mid; each array (k, m).

    ``directions`` are r directions in which (Δ, e, f) may change, see `Jet`; shape (k, 3m, r), or (1, 3m, r) if they
    are the same for all pairs.
    """

    delta: FloatArray
    e: FloatArray
    f: FloatArray
    directions: FloatArray

    @classmethod
    def of(cls, curve: Curve, i: IntArray, j: IntArray) -> "EdgePairs":
        """The pairs (i, j) of edges of a curve, without directions."""
        delta, e, f = _shape(curve.mesh, curve.vertices, i, j)
        return cls(delta, e, f, np.empty((1, 3 * delta.shape[1], 0)))

    def moving(self, mesh: Mesh, i: IntArray, j: IntArray, v: FloatArray) -> "EdgePairs":
        """The pairs with the direction of vertex velocities ``v``, shape (n, m)."""
        return self._replace(directions=np.hstack(_shape(mesh, v, i, j))[:, :, None])

    def with_coordinates(self) -> "EdgePairs":
        """The pairs with the 3m coordinate directions."""
        return self._replace(directions=np.eye(3 * self.delta.shape[1])[None])

    def combination(self, c: Combination) -> FloatArray:
        """The vector c₀ Δ + c₁ e + c₂ f of every pair, shape (k, m)."""
        return np.asarray(c[0] * self.delta + c[1] * self.e + c[2] * self.f)

    def along(self, first: FloatArray) -> FloatArray:
        """Derivatives along the directions, shape (k, r), from those by (Δ, e, f), shape (k, 3m)."""
        return np.asarray((first[:, None, :] @ self.directions)[:, 0, :])

    def inner(self, a: Combination, b: Combination) -> Jet:
        """The inner product of two combinations, as a function of the 3m coordinates of (Δ, e, f)."""
        u, v = self.combination(a), self.combination(b)
        k, m = u.shape
        first = np.asarray(a)[:, None] * v[:, None, :] + np.asarray(b)[:, None] * u[:, None, :]
        first = first.reshape(k, 3 * m)
        return Jet(np.einsum("km,km->k", u, v), first, self.along(first), _polar_form(a, b, m) @ self.directions)


def _shape(mesh: Mesh, p: FloatArray, i: IntArray, j: IntArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Δ, e and f of pairs of edges; the end points are subtracted first: edges may be close and far from the origin."""
    x0, x1, y0, y1 = p[mesh.tails[i]], p[mesh.heads[i]], p[mesh.tails[j]], p[mesh.heads[j]]
    return 0.5 * ((x0 - y0) + (x1 - y1)), x1 - x0, y1 - y0


@cache
def _polar_form(a: Combination, b: Combination, m: int) -> FloatArray:
    """The second derivative of an inner product of combinations, shape (3m, 3m)."""
    return frozen(np.kron(np.outer(a, b) + np.outer(b, a), np.eye(m)))


def scatter_first(mesh: Mesh, i: IntArray, j: IntArray, first: FloatArray) -> FloatArray:
    """Derivative by the vertices, shape (n, m), from those by (Δ, e, f) of pairs (i, j) of edges, shape (k, 3m)."""
    by_delta, by_e, by_f = np.split(first, 3, axis=1)
    by_midpoint, by_edge = (np.zeros((mesh.edges, by_delta.shape[1])) for _ in range(2))
    np.add.at(by_midpoint, i, by_delta)
    np.subtract.at(by_midpoint, j, by_delta)
    np.add.at(by_edge, i, by_e)
    np.add.at(by_edge, j, by_f)
    return mesh.scatter(0.5 * by_midpoint - by_edge, 0.5 * by_midpoint + by_edge)


def scatter_second(mesh: Mesh, i: IntArray, j: IntArray, second: FloatArray) -> sp.csr_array:
    """Second derivative by the vertices, sparse (n·m, n·m), from those by (Δ, e, f) of pairs, shape (k, 3m, 3m)."""
    k, m = len(i), second.shape[1] // 3
    corners = np.stack([mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j]], axis=1)
    index = (m * corners[:, :, None] + np.arange(m)).reshape(k, 4 * m)
    spread = np.kron(_CORNERS, np.eye(m))
    blocks = spread @ second @ spread.T
    rows, columns = np.broadcast_arrays(index[:, :, None], index[:, None, :])
    size = mesh.size * m
    return sp.csr_array((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
