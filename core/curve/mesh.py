"""Connectivity of polygons, closed or open: which vertices each edge joins, and which edges are neighbours."""

import operator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from reprlib import repr as short

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..base import BoolArray, CurveError, FloatArray, IntArray, frozen, is_list, shown

_KINDS = {True: (3, "a closed polygon"), False: (2, "an open polygon")}  # by whether closed: least number of vertices


@dataclass(frozen=True)
class Mesh:
    """Connectivity of one or more polygons, closed or open, sharing one array of vertices.

    Edge I runs from vertex ``tails[I]`` to vertex ``heads[I]``; vertices of one component are consecutive, and so are
    its edges.  A closed component has as many edges as vertices, an open one (an arc) one less.

    Parameters
    ----------
    component_sizes
        Number of vertices of every component: at least 3, or 2 where it is open.
    closed
        Whether each component is closed; by default all are.

    Raises
    ------
    CurveError
        If there is no component, one has too few vertices, or ``closed`` has another length.
    """

    component_sizes: tuple[int, ...]
    closed: tuple[bool, ...] = ()

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "component_sizes", tuple(map(operator.index, self.component_sizes)))
        except TypeError as error:
            raise CurveError(
                f"component_sizes is {shown(self.component_sizes)}; it must be a tuple of whole numbers, such as (9, 9)"
            ) from error
        if not self.component_sizes:
            raise CurveError("the curve is empty: it has no component; give at least one polygon")
        components, flags = len(self.component_sizes), tuple(self.closed) if is_list(self.closed) else (None,)
        if len(flags) not in (0, components) or not all(isinstance(flag, bool | np.bool_) for flag in flags):
            told = f"closed is {shown(self.closed)}; it must have True or False for each of {components} components"
            raise CurveError(told)
        object.__setattr__(self, "closed", tuple(map(bool, flags)) or (True,) * components)
        for k, (size, closed) in enumerate(zip(self.component_sizes, self.closed, strict=True), start=1):
            least, kind = _KINDS[closed]
            if size < least:
                noun = "vertex" if size == 1 else "vertices"
                raise CurveError(f"component {k} has {size} {noun}; {kind} needs at least {least} different vertices")

    @classmethod
    def of_edges(cls, edge_counts: IntArray, closed: tuple[bool, ...]) -> "Mesh":
        """The mesh whose components have these numbers of edges."""
        return cls(tuple((edge_counts + ~np.asarray(closed)).tolist()), closed)

    def __reduce__(self) -> tuple[type["Mesh"], tuple[tuple[int, ...], tuple[bool, ...]]]:
        # made anew, because arrays come out of pickles and deep copies writable
        return Mesh, (self.component_sizes, self.closed)

    def __repr__(self) -> str:
        return f"Mesh({short(self.component_sizes)}, closed={short(self.closed)})"

    @cached_property
    def size(self) -> int:
        """Number of vertices n."""
        return sum(self.component_sizes)

    @cached_property
    def edges(self) -> int:
        """Number of edges: the number of vertices less that of open components."""
        return int(self.edge_counts.sum())

    @cached_property
    def edge_counts(self) -> IntArray:
        """Number of edges of every component; shape (components,)."""
        return frozen(np.asarray(self.component_sizes) - ~np.asarray(self.closed))

    @cached_property
    def all_closed(self) -> bool:
        """Whether no component is open."""
        return all(self.closed)

    @cached_property
    def offsets(self) -> IntArray:
        """Index of the first vertex of each component, and their number at the end; shape (components + 1,)."""
        return frozen(np.concatenate([[0], np.cumsum(self.component_sizes)]))

    @cached_property
    def edge_offsets(self) -> IntArray:
        """Index of the first edge of each component, and their number at the end; shape (components + 1,)."""
        return frozen(np.concatenate([[0], np.cumsum(self.edge_counts)]))

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """The vertices of each component, as slices."""
        return _slices(self.offsets)

    @cached_property
    def edge_slices(self) -> tuple[slice, ...]:
        """The edges of each component, as slices."""
        return _slices(self.edge_offsets)

    @cached_property
    def ends(self) -> IntArray:
        """First and last vertex of every open component; shape (open components, 2)."""
        is_open = ~np.asarray(self.closed)
        return frozen(np.stack([self.offsets[:-1], self.offsets[1:] - 1], axis=1)[is_open])

    @cached_property
    def arc_edges(self) -> IntArray:
        """The edges of the open components."""
        return frozen(np.flatnonzero(~np.asarray(self.closed)[self.edge_component]))

    @cached_property
    def tails(self) -> IntArray:
        """Tail vertex I↓ of each edge; shape (edges,)."""
        return frozen(np.delete(np.arange(self.size), self.ends[:, 1]))

    @cached_property
    def heads(self) -> IntArray:
        """Head vertex I↑ of each edge; shape (edges,)."""
        return frozen(self.cycle[self.tails])

    @cached_property
    def cycle(self) -> IntArray:
        """The vertex after each vertex; after the last of a component its first, closed or not; shape (n,)."""
        after = np.arange(1, self.size + 1)
        after[self.offsets[1:] - 1] = self.offsets[:-1]
        return frozen(after)

    @cached_property
    def anticycle(self) -> IntArray:
        """The vertex before each vertex; before the first of a component its last, closed or not; shape (n,)."""
        return frozen(np.argsort(self.cycle))

    @cached_property
    def outgoing(self) -> IntArray:
        """The edge that begins at each vertex; at the end of an arc, the one that ends there.  Shape (n,)."""
        return frozen(_with(_with(np.empty(self.size, dtype=np.intp), self.heads), self.tails))

    @cached_property
    def incoming(self) -> IntArray:
        """The edge that ends at each vertex; at the beginning of an arc, the one that begins there.  Shape (n,)."""
        return frozen(_with(_with(np.empty(self.size, dtype=np.intp), self.tails), self.heads))

    @cached_property
    def next(self) -> IntArray:
        """The edge after each edge; for the last edge of an arc the edge itself.  Shape (edges,)."""
        return frozen(self.outgoing[self.heads])

    @cached_property
    def previous(self) -> IntArray:
        """The edge before each edge; for the first edge of an arc the edge itself.  Shape (edges,)."""
        return frozen(self.incoming[self.tails])

    @cached_property
    def inner(self) -> IntArray:
        """The vertices where two edges meet: all but the ends of arcs."""
        return frozen(np.delete(np.arange(self.size), self.ends.ravel()))

    @cached_property
    def component(self) -> IntArray:
        """Component of each vertex; shape (n,)."""
        return frozen(np.repeat(np.arange(len(self.component_sizes)), self.component_sizes))

    @cached_property
    def edge_component(self) -> IntArray:
        """Component of each edge; shape (edges,)."""
        return frozen(np.repeat(np.arange(len(self.component_sizes)), self.edge_counts))

    @cached_property
    def difference(self) -> sp.csr_array:
        """Sparse matrix D of edge differences, (D U)_I = U(I↑) − U(I↓); shape (edges, n)."""
        return self._incidence(-1.0, 1.0)

    @cached_property
    def average(self) -> sp.csr_array:
        """Sparse matrix of midpoint values, (U(I↑) + U(I↓))/2; shape (edges, n)."""
        return self._incidence(0.5, 0.5)

    def _incidence(self, tail: float, head: float) -> sp.csr_array:
        edges = np.arange(self.edges)
        return sp.csr_array(
            (
                np.concatenate([np.full(self.edges, tail), np.full(self.edges, head)]),
                (np.concatenate([edges, edges]), np.concatenate([self.tails, self.heads])),
            ),
            shape=(self.edges, self.size),
        )

    def index_distance(self, i: IntArray, j: IntArray) -> IntArray:
        """Number of edges from ``i`` to ``j`` the shorter way along the curve; the mesh's size across components."""
        gap = np.abs(i - j)
        length = np.where(self.closed, self.edge_counts, 2 * self.size)[self.edge_component[i]]
        together = self.edge_component[i] == self.edge_component[j]
        return np.where(together, np.minimum(gap, length - gap), self.size)

    def disjoint(self, i: IntArray, j: IntArray) -> BoolArray:
        """Whether the closures of edges ``i`` and ``j`` are disjoint: no vertex in common."""
        return np.asarray((i != j) & (self.next[i] != j) & (self.next[j] != i))

    def changes(self, u: FloatArray) -> FloatArray:
        """U(I↑) − U(I↓) of values at the vertices; (n, …) to (edges, …)."""
        return u.take(self.heads, axis=0) - (u if self.all_closed else u.take(self.tails, axis=0))

    def scatter(self, at_tails: FloatArray, at_heads: FloatArray) -> FloatArray:
        """At each vertex, add up the values given at the tails and the heads of its edges; (edges, …) to (n, …)."""
        total = self.at_tails(at_tails)
        if self.all_closed:
            total += at_heads.take(self.previous, axis=0)
        else:
            total[self.heads] += at_heads  # no vertex is the head of two edges
        return total

    def at_tails(self, values: FloatArray, elsewhere: FloatArray | float = 0.0) -> FloatArray:
        """Values of the edges at the vertices where they begin, others where an arc ends; (edges, …) to (n, …)."""
        if self.all_closed:
            return values.astype(np.result_type(values, np.float64))
        placed = np.empty((self.size, *values.shape[1:]), np.result_type(values, np.float64))
        placed[...] = elsewhere
        placed[self.tails] = values
        return placed


def component_order(mesh: Mesh, points: FloatArray) -> IntArray:
    """Edges in curve order, the components sorted so that near ones come next to each other; (m, n) -> (edges,)."""
    if len(mesh.component_sizes) < 3:
        return np.arange(mesh.edges)
    starts = mesh.offsets[:-1]
    centers = 0.5 * (np.minimum.reduceat(points, starts, axis=1) + np.maximum.reduceat(points, starts, axis=1))
    rank = np.empty(len(starts), dtype=np.intp)
    rank[near_to_near(centers)] = np.arange(len(starts))
    return np.argsort(rank[mesh.edge_component], kind="stable")


def near_to_near(points: FloatArray) -> IntArray:
    """Points in an order in which neighbours in space are near each other, that of a k-d tree; (m, k) -> (k,)."""
    return np.asarray(cKDTree(points.T, leafsize=1).indices)


def _slices(offsets: IntArray) -> tuple[slice, ...]:
    return tuple(slice(int(a), int(b)) for a, b in pairwise(offsets))


def _with(edge_at: IntArray, vertices: IntArray) -> IntArray:
    """Assign each edge, or vertex, to a vertex of its own."""
    edge_at[vertices] = np.arange(len(vertices))
    return edge_at
