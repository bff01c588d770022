"""Connectivity of closed polygons: which vertices each edge joins, and which edges are neighbours."""

import operator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..errors import CurveError
from ..types import BoolArray, FloatArray, IntArray, frozen


@dataclass(frozen=True)
class Mesh:
    """Connectivity of one or more closed polygons sharing one array of vertices.

    Edge I runs from vertex ``tails[I]`` to vertex ``heads[I]``; vertices of one component are
    consecutive, and so are its edges.

    Parameters
    ----------
    component_sizes
        Number of vertices of every component, each at least 3.

    Raises
    ------
    CurveError
        If these are no whole numbers, there is no component, or one has fewer than 3 vertices.
    """

    component_sizes: tuple[int, ...]

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "component_sizes", tuple(map(operator.index, self.component_sizes)))
        except TypeError as error:
            raise CurveError(
                f"component_sizes is {self.component_sizes!r}; it must be a tuple of whole numbers, such as (10, 12)"
            ) from error
        if not self.component_sizes:
            raise CurveError("the curve is empty: it has no component; give at least one closed polygon")
        for k, size in enumerate(self.component_sizes):
            if size < 3:
                noun = "vertex" if size == 1 else "vertices"
                raise CurveError(
                    f"component {k + 1} has {size} {noun}; a closed polygon needs at least 3 different vertices"
                )

    def __reduce__(self) -> tuple[type["Mesh"], tuple[tuple[int, ...]]]:
        # made anew, because arrays come out of pickles and deep copies writable
        return Mesh, (self.component_sizes,)

    @cached_property
    def size(self) -> int:
        """Number of vertices, which for closed polygons is also the number of edges."""
        return sum(self.component_sizes)

    @cached_property
    def offsets(self) -> IntArray:
        """Index of the first vertex of each component, and the size at the end; shape (components + 1,)."""
        return frozen(np.concatenate([[0], np.cumsum(self.component_sizes)]))

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """The vertices (and edges) of each component, as slices."""
        return tuple(slice(int(a), int(b)) for a, b in zip(self.offsets[:-1], self.offsets[1:], strict=True))

    @cached_property
    def tails(self) -> IntArray:
        """Tail vertex I↓ of each edge; shape (n,)."""
        return frozen(np.arange(self.size))

    @cached_property
    def heads(self) -> IntArray:
        """Head vertex I↑ of each edge; shape (n,)."""
        heads = np.arange(1, self.size + 1)
        heads[self.offsets[1:] - 1] = self.offsets[:-1]
        return frozen(heads)

    @cached_property
    def previous(self) -> IntArray:
        """The edge before each edge (whose head is this edge's tail); shape (n,)."""
        previous = np.empty(self.size, dtype=np.intp)
        previous[self.heads] = np.arange(self.size)
        return frozen(previous)

    @cached_property
    def component(self) -> IntArray:
        """Component of each vertex (and edge); shape (n,)."""
        return frozen(np.repeat(np.arange(len(self.component_sizes)), self.component_sizes))

    @cached_property
    def difference(self) -> sp.csr_array:
        """Sparse matrix D of edge differences, (D U)_I = U(I↑) − U(I↓); shape (n, n)."""
        return self._incidence(-1.0, 1.0)

    @cached_property
    def average(self) -> sp.csr_array:
        """Sparse matrix of midpoint values, (U(I↑) + U(I↓))/2; shape (n, n)."""
        return self._incidence(0.5, 0.5)

    def interpolation(self, t: float) -> sp.csr_array:
        """Sparse matrix of the values at parameter ``t`` of each edge, (1−t) U(I↓) + t U(I↑)."""
        return self._incidence(1.0 - t, t)

    def _incidence(self, tail: float, head: float) -> sp.csr_array:
        edges = np.arange(self.size)
        return sp.csr_array(
            (
                np.concatenate([np.full(self.size, tail), np.full(self.size, head)]),
                (np.concatenate([edges, edges]), np.concatenate([self.tails, self.heads])),
            ),
            shape=(self.size, self.size),
        )

    def index_distance(self, i: IntArray, j: IntArray) -> IntArray:
        """Number of edges from edge ``i`` to edge ``j`` along the curve, either way round.

        Edges of different components are further apart than any two of the same: they get the mesh's size.
        """
        gap = np.abs(i - j)
        length = np.asarray(self.component_sizes)[self.component[i]]
        return np.where(self.component[i] == self.component[j], np.minimum(gap, length - gap), self.size)

    def disjoint(self, i: IntArray, j: IntArray) -> BoolArray:
        """Whether the closures of edges ``i`` and ``j`` are disjoint: no vertex in common."""
        return np.asarray(self.index_distance(i, j) > 1)

    def scatter(self, at_tails: FloatArray, at_heads: FloatArray) -> FloatArray:
        """Add values given at the tail and the head of each edge up at the vertices; shapes (n,) or (n, m)."""
        return np.asarray(at_tails + at_heads[self.previous])  # edge I begins at vertex I
