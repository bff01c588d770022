"""Pairs of straight edges in three vectors, Δ between the midpoints and the edges e and f, and their chain rule.

One pass goes over all unordered pairs in blocks that fit the processor's cache.

Derivatives along vectors are by complex steps, exact to rounding: no difference is formed.

    d/dt f(x + t v) = Im f(x + iεv)/ε  at t = 0

for f analytic and real on real arguments, with ε so small that its square vanishes beside any number (Squire and Trapp,
SIAM Review 40, 1998).  Comparisons go by real parts, as NumPy orders complex numbers.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from ..base import BoolArray, FloatArray, IntArray, dot, frozen
from ..curve import Curve, Mesh

STEP = 1e-100
Combination = tuple[float, float, float]
DELTA, E, F = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

# how the tail and head of the first edge and of the second (rows) enter Δ, e and f (columns)
CORNERS = np.array([[0.5, -1.0, 0.0], [0.5, 1.0, 0.0], [-0.5, 0.0, -1.0], [-0.5, 0.0, 1.0]])
ROWS_TIMES_COLUMNS = 24_000  # doubles in one tile array; some ten of them should fit a second-level cache


@dataclass(frozen=True, eq=False)
class Jet:
    """A quantity of k pairs of edges, shape (k,), and its derivatives by c local variables, shape (k, c)."""

    value: FloatArray
    first: FloatArray

    def __add__(self, other: "Jet") -> "Jet":
        return Jet(self.value + other.value, self.first + other.first)

    def __sub__(self, other: "Jet") -> "Jet":
        return self + other.scaled(-1.0)

    def __mul__(self, other: "Jet") -> "Jet":
        first = self.value[:, None] * other.first + other.value[:, None] * self.first
        return Jet(self.value * other.value, first)

    def scaled(self, factor: float) -> "Jet":
        return Jet(factor * self.value, factor * self.first)

    def where(self, kept: BoolArray) -> "Jet":
        """The quantity for some pairs, shape (k,), and 0 for the others, even where it is infinite."""
        return Jet(np.where(kept, self.value, 0.0), np.where(kept[:, None], self.first, 0.0))

    def compose(self, value: FloatArray, slope: FloatArray) -> "Jet":
        """A function of the quantity, by its values and derivatives there, each (k,)."""
        return Jet(value, slope[:, None] * self.first)

    def sqrt(self) -> "Jet":
        root = np.sqrt(self.value)
        return self.compose(root, 0.5 / root)

    def reciprocal(self) -> "Jet":
        inverse = 1.0 / self.value
        return self.compose(inverse, -(inverse**2))

    def log(self) -> "Jet":
        return self.compose(np.log(self.value), 1.0 / self.value)


class EdgePairs(NamedTuple):
    """k pairs of edges: x(s) = x_mid + (s − ½) e, y(t) = y_mid + (t − ½) f, Δ = x_mid − y_mid; each array (k, m)."""

    delta: FloatArray
    e: FloatArray
    f: FloatArray

    @classmethod
    def of(cls, mesh: Mesh, p: FloatArray, i: IntArray, j: IntArray) -> "EdgePairs":
        """Pairs (i, j) of edges between vertices, real or complex; ends are subtracted first, as edges may be close."""
        x0, x1, y0, y1 = (p.take(end.take(k), axis=0) for k in (i, j) for end in (mesh.tails, mesh.heads))
        return cls(0.5 * ((x0 - y0) + (x1 - y1)), x1 - x0, y1 - y0)

    def along_coordinates(self) -> "Iterator[EdgePairs]":
        """The pairs after complex steps along each of the 3m coordinates of (Δ, e, f)."""
        for units in np.eye(3 * self.e.shape[1]).reshape(-1, 3, self.e.shape[1]):
            yield EdgePairs(*map(stepped, self, units))

    def combination(self, c: Combination) -> FloatArray:
        """The vector c₀ Δ + c₁ e + c₂ f of every pair, shape (k, m)."""
        return np.asarray(c[0] * self.delta + c[1] * self.e + c[2] * self.f)

    def inner(self, a: Combination, b: Combination) -> Jet:
        """The inner product of two combinations, as a function of the 3m coordinates of (Δ, e, f)."""
        u, v = self.combination(a), self.combination(b)
        first = np.asarray(a)[:, None] * v[:, None, :] + np.asarray(b)[:, None] * u[:, None, :]
        return Jet(dot(u, v), first.reshape(len(u), 3 * u.shape[1]))


def scatter_first(mesh: Mesh, i: IntArray, j: IntArray, first: FloatArray) -> FloatArray:
    """Derivative by the vertices, shape (n, m), from those by (Δ, e, f) of pairs (i, j) of edges, shape (k, 3m)."""
    by_delta, by_e, by_f = np.split(np.ascontiguousarray(first).view(np.float64), 3, axis=1)  # of complex steps too
    edges = np.concatenate([i, j])

    def summed(by_i: FloatArray, by_j: FloatArray) -> FloatArray:
        columns = np.concatenate([by_i, by_j]).T
        return np.stack([np.bincount(edges, c, mesh.edges) for c in columns], axis=1).view(first.dtype)

    by_midpoint, by_edge = summed(by_delta, -by_delta), summed(by_e, by_f)
    return mesh.scatter(0.5 * by_midpoint - by_edge, 0.5 * by_midpoint + by_edge)


def scatter_second(mesh: Mesh, i: IntArray, j: IntArray, second: FloatArray) -> sp.csr_array:
    """Second derivative by the vertices, sparse (n·m, n·m), from those by (Δ, e, f) of pairs, shape (k, 3m, 3m)."""
    n, m = mesh.size, second.shape[1] // 3
    corners = np.stack([mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j]], axis=1)
    spread = np.kron(CORNERS, np.eye(m))
    blocks = (spread @ second @ spread.T).reshape(-1, 4, m, 4, m).swapaxes(2, 3).reshape(-1, m * m)
    # pairs of vertices are in many pairs of edges: the sums of each of the entries of their blocks
    pairs, number = np.unique((n * corners[:, :, None] + corners[:, None, :]).ravel(), return_inverse=True)
    sums = np.stack([np.bincount(number, entries, len(pairs)) for entries in blocks.T], axis=1)
    begins = np.searchsorted(pairs, n * np.arange(n + 1))
    return sp.csr_array(sp.bsr_array((sums.reshape(-1, m, m), pairs % n, begins), shape=(n * m, n * m)))


class PairTerm(ABC):
    """A sum over pairs of edges that are near each other; its second derivative is by complex steps, and sparse."""

    @abstractmethod
    def shares(self, curve: Curve) -> Iterator[tuple[IntArray, IntArray, Callable[[EdgePairs], Jet]]]:
        """Yield pairs (i, j) of edges, some at a time, each of shape (k,), and what their shares are functions of."""

    def value(self, curve: Curve) -> float:
        """The sum, which may be infinite."""
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        value, first = self._sum(curve, curve.vertices)
        return float(value), frozen(first)

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        return change(self._sum(curve, stepped(curve.vertices, v))[1])

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        total = sp.csr_array((curve.vertices.size, curve.vertices.size))
        for i, j, share in self.shares(curve):
            pairs = EdgePairs.of(curve.mesh, curve.vertices, i, j)
            second = [change(share(each).first) for each in pairs.along_coordinates()]
            total = total + scatter_second(curve.mesh, i, j, np.stack(second, axis=2))
        return total

    def _sum(self, curve: Curve, vertices: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The sum and its derivative at a curve's vertices, or after a complex step from them."""
        total, first = np.zeros((), vertices.dtype), np.zeros_like(vertices)
        for i, j, share in self.shares(curve):
            jet = share(EdgePairs.of(curve.mesh, vertices, i, j))
            total = total + jet.value.sum()
            if not np.isfinite(total):
                return total, np.zeros_like(vertices)
            first = first + scatter_first(curve.mesh, i, j, jet.first)
        return total, first


class Tile(NamedTuple):
    """A block of edge pairs (I, J), I in ``rows`` and J in ``columns``."""

    rows: slice
    columns: slice
    excluded: BoolArray  # pairs that do not count: edges with a common vertex, and those in another tile or place


EdgePairIndices = tuple[IntArray, IntArray]
"""Unordered pairs of edges (i, j), each of shape (pairs,)."""


def pair_tiles(mesh: Mesh, without: EdgePairIndices | None = None, size: int = ROWS_TIMES_COLUMNS) -> Iterator[Tile]:
    """Cover every unordered pair of edges with disjoint closures exactly once, except some that are left out."""
    n = mesh.edges
    touching = np.stack([np.arange(n), mesh.next])
    left_out = np.sort(touching if without is None else np.hstack([touching, np.stack(without)]), axis=0)
    left_out = left_out[:, np.argsort(left_out[0])]
    begins = np.searchsorted(left_out[0], np.arange(n + 1))
    first = 0
    while first < n:
        last = min(n, first + max(1, size // (n - first)))
        excluded = np.zeros((last - first, n - first), dtype=np.bool_)
        excluded[:, : last - first] = np.tri(last - first, dtype=np.bool_)
        row, column = left_out[:, begins[first] : begins[last]] - first
        excluded[row, column] = True
        yield Tile(slice(first, last), slice(first, n), excluded)
        first = last


class SteppedCurve(Curve):
    """A curve after a complex step along v, shape (n, m): all that is computed from it is complex."""

    def __init__(self, curve: Curve, v: FloatArray) -> None:
        object.__setattr__(self, "vertices", stepped(curve.vertices, v))
        object.__setattr__(self, "mesh", curve.mesh)


def stepped(x: FloatArray, v: FloatArray) -> FloatArray:
    """x + iεv."""
    return np.asarray(x + STEP * 1j * v)


def half_changes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Im |d|²/2 = ⟨Re d, Im d⟩, d = x_i − y_j, after complex steps of points, (k, m) and (l, m); shape (k, l)."""
    own, other = (dot(points.real, points.imag)[:, None] for points in (x, y))
    left = np.hstack([-x.imag, -x.real, own, np.ones_like(own)])
    return np.asarray(left @ np.hstack([y.real, y.imag, np.ones_like(other), other]).T)


def change(f: FloatArray) -> FloatArray:
    """The derivative along v, from f(x + iεv)."""
    return np.asarray(f.imag / STEP)


def arctan2(y: FloatArray, x: FloatArray) -> FloatArray:
    """NumPy's arctan2, continued to complex steps."""
    angle = np.arctan2(y.real, x.real)
    if np.iscomplexobj(x):
        angle = angle + 1j * (x.real * y.imag - y.real * x.imag) / (x.real**2 + y.real**2)
    return np.asarray(angle)
