"""Pins: vertices that stay where they are, and the arcs of the curve between them."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from ..base import BoolArray, FloatArray, IntArray, frozen
from .curve import Curve
from .mesh import Mesh

TAUT = 1e-9  # slack of an arc, relative to its ends' distance, up to which it is straight: rounding leaves far less
NOWHERE: IntArray = frozen(np.empty(0, dtype=np.intp))


@dataclass(frozen=True, eq=False)
class Pins:
    """Vertices, ascending, held at exactly their positions, (k, m), in the user's units; so any mesh finds them."""

    vertices: IntArray = field(default_factory=lambda: NOWHERE)
    positions: FloatArray = field(default_factory=lambda: np.empty((0, 0)))

    def __len__(self) -> int:
        return len(self.vertices)

    @classmethod
    def of(cls, curve: Curve, vertices: IntArray) -> "Pins":
        """Some vertices of a curve, along with those of taut arcs between them, which cannot move either."""
        taut = [ends_of(curve.mesh, span.edges) for span in spans(curve, vertices) if span.taut]
        held = np.unique(np.concatenate([vertices, *taut]))
        return cls(frozen(held), frozen(curve.vertices[held]))

    @classmethod
    def at(cls, curve: Curve, positions: FloatArray) -> "Pins":
        """The vertices of a curve at positions, shape (k, m), each of which is the position of a vertex."""
        place = {tuple(vertex): k for k, vertex in enumerate(curve.vertices.tolist())}
        return cls.of(curve, np.array([place[tuple(position)] for position in positions.tolist()], dtype=np.intp))

    def on(self, curve: Curve) -> "Pins":
        """The same on another mesh; new vertices on edges between two pins are held as well."""
        return Pins.at(curve, self.positions) if len(self) else self

    def with_neighbours(self, curve: Curve) -> "Pins":
        """The pins and their neighbours: the edges in between have fixed lengths, and so fixed tangents."""
        mesh, here = curve.mesh, holds(curve.mesh, self.vertices)
        after, before = mesh.heads[here[mesh.tails]], mesh.tails[here[mesh.heads]]
        return Pins.of(curve, np.unique(np.concatenate([self.vertices, after, before])))

    def put_back(self, vertices: FloatArray, positions: FloatArray) -> FloatArray:
        """The vertices, shape (n, m), with the pinned ones at positions, shape (k, m); read-only."""
        placed = np.array(vertices)
        placed[self.vertices] = positions
        return frozen(placed)


NO_PINS = Pins()


def holds(mesh: Mesh, vertices: IntArray) -> BoolArray:
    """Whether each vertex of a mesh is one of these; shape (n,)."""
    held = np.zeros(mesh.size, dtype=bool)
    held[vertices] = True
    return held


def free_edges(mesh: Mesh, pins: IntArray) -> IntArray:
    """The edges whose ends are not both pinned."""
    held = holds(mesh, pins)
    return np.flatnonzero(~(held[mesh.tails] & held[mesh.heads]))


def arcs(mesh: Mesh, pins: IntArray) -> list[IntArray]:
    """The edges, ascending, of each arc from pin to pin or to an end of the curve, and of each component without pins.

    Edges are on the same arc if they meet in an unpinned vertex: connected components of the graph with edges and
    free vertices as its nodes.
    """
    edges, free = np.arange(len(mesh.tails)), ~holds(mesh, pins)
    edge, vertex = np.concatenate([edges, edges]), np.concatenate([mesh.tails, mesh.heads])
    joined, nodes = free[vertex], len(edges) + mesh.size
    places = edge[joined], len(edges) + vertex[joined]
    graph = sp.coo_array((np.ones(len(places[0])), places), shape=(nodes, nodes))
    label = connected_components(graph, directed=False)[1][: len(edges)]
    order = np.argsort(label, kind="stable")
    return list(np.split(order, np.flatnonzero(np.diff(label[order])) + 1))


def ends_of(mesh: Mesh, edges: IntArray) -> IntArray:
    """The ends of edges, each once."""
    return np.asarray(np.unique(np.concatenate([mesh.tails[edges], mesh.heads[edges]])))


class Span(NamedTuple):
    """An arc between two different pins: its edges, ascending, the pins, their distance, and its length."""

    edges: IntArray
    ends: tuple[int, int]
    distance: float
    length: float

    @property
    def taut(self) -> bool:
        """Whether it is straight, so that nothing on it can move."""
        return self.length <= (1.0 + TAUT) * self.distance


def spans(curve: Curve, pins: IntArray) -> Iterator[Span]:
    """All arcs between two different pins."""
    held = holds(curve.mesh, pins)
    for arc in arcs(curve.mesh, pins) if len(pins) else []:
        ends = ends_of(curve.mesh, arc)
        ends = ends[held[ends]]
        if len(ends) == 2:
            distance = float(np.linalg.norm(np.diff(curve.vertices[ends], axis=0)))
            yield Span(arc, (int(ends[0]), int(ends[1])), distance, float(curve.edge_lengths[arc].sum()))
