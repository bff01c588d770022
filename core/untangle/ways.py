"""Ways for strands in the plane of a drawing: across as few others as can be, and short.

The plane is cut into triangles whose corners are the nodes of the drawing and points of a grid, and among whose sides
are all pieces of the curve.  A way goes from one triangle to the next, and pays for its length and for pieces that it
crosses.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import Delaunay, cKDTree

from ..base import FloatArray
from ..curve import arc_lengths
from ..knots.diagrams.projection import Projection
from ..knots.diagrams.rerouting import Strand


class Way(NamedTuple):
    """Where a strand leaves the rest of the curve and comes back to it, and how it may go on between these places."""

    ends: tuple[float, float]  # on the curve, as tails plus fractions
    corners: FloatArray  # shape (k, 2)
    route: list[int]  # the darts that it crosses from the left


class Plane:
    """A drawing's plane in triangles; its faces are about as wide as ``face``."""

    def __init__(self, drawing: Projection, face: float) -> None:
        self.drawing, self.face, nodes = drawing, face, drawing.nodes
        low, high = nodes.min(axis=0) - 2.0 * face, nodes.max(axis=0) + 2.0 * face
        x, y = np.meshgrid(*(np.arange(a, b, 0.5 * face) for a, b in zip(low, high, strict=True)))
        x[::2] += 0.25 * face
        grid = np.column_stack([x.ravel(), y.ravel()])
        points = np.concatenate([nodes, grid[cKDTree(nodes).query(grid)[0] > 0.3 * face]])
        chains = list(drawing.chains())
        pieces = np.array([ends for _, chain in chains for ends in pairwise(chain)])
        edges = np.repeat([edge for edge, _ in chains], [len(chain) - 1 for _, chain in chains])
        for _ in range(16):  # pieces that are no sides are halved
            triangles = Delaunay(points)
            corners, key = triangles.simplices.astype(np.int64), np.array([len(points), 1])
            gates = np.stack([np.roll(corners, -1, axis=1), np.roll(corners, -2, axis=1)]).reshape(2, -1)
            sides = key @ gates
            missing = ~(np.isin(pieces @ key, sides) | np.isin(pieces @ key[::-1], sides))
            if not missing.any():
                break
            middle = len(points) + np.arange(missing.sum())
            points = np.concatenate([points, points[pieces[missing]].mean(axis=1)])
            first = np.flatnonzero(missing) + np.arange(len(middle))
            pieces, edges = (np.repeat(each, 1 + missing, axis=0) for each in (pieces, edges))
            pieces[first, 1] = pieces[first + 1, 0] = middle
        self.points, self.pieces, self.edges = points, pieces, edges
        self.first = np.searchsorted(edges, np.arange(edges[-1] + 2))  # piece of each edge of the diagram
        # gates: from triangles to their neighbours, through sides that have the triangles on their left
        leave, enter = np.repeat(np.arange(len(corners)), 3), triangles.neighbors.ravel()
        order = np.lexsort((enter, leave))
        order = order[enter[order] >= 0]
        self.leave, self.enter, gates = leave[order], enter[order], gates[:, order]
        self.middle = points[gates].mean(axis=0)
        # the piece that is crossed through each gate, and the dart, if there are any
        self.piece, self.dart = np.full((2, len(self.leave)), -1)
        order = np.argsort(pieces @ key)
        for side, way in enumerate((gates, gates[::-1])):
            at = order[np.searchsorted(pieces @ key, key @ way, sorter=order).clip(max=len(order) - 1)]
            found = pieces[at] @ key == key @ way
            self.piece[found], self.dart[found] = at[found], 2 * edges[at[found]] + side
        center = points[corners].mean(axis=1)
        room = cKDTree(nodes).query(center)[0] / face
        # farther from the curve a way is shorter
        self.length = (1.0 + np.minimum(0.02 / np.maximum(room, 0.01) ** 2, 3.0))[self.enter]
        self.length *= sum(np.linalg.norm(self.middle - center[each], axis=1) for each in (self.leave, self.enter))
        rows = np.searchsorted(self.leave, np.arange(len(corners) + 1))
        self.graph = sp.csr_array((self.length, self.enter, rows), shape=(len(corners), len(corners)))

    def place(self, edge: int, share: float) -> tuple[int, float]:
        """The piece at a share of an edge of the diagram, and the place of its middle on the curve."""
        pieces = np.arange(self.first[edge], self.first[edge + 1])
        lengths = np.linalg.norm(np.subtract(*self.points[self.pieces[pieces].T]), axis=1)
        ends = np.cumsum(lengths)
        k = int(np.searchsorted(ends, share * ends[-1]))
        names, stops = self.drawing.stops(edge)
        along = arc_lengths(self.drawing.nodes[names])
        at = np.interp((ends[k] - 0.5 * lengths[k]) / ends[-1] * along[-1], along, stops)
        return int(pieces[k]), self.drawing.wrapped(edge, float(at))

    def way(self, strand: Strand, crossing: float = 100.0) -> Way | None:
        """The best way for a strand, whose own pieces cost nothing; None if there is none that crosses fewer others.

        It may be so many faces longer to cross one strand less.
        """
        first, last = strand.first, strand.inner[-1]
        (begin, start), (goal, end) = (
            self.place(first, 0.7 if first == last else 0.5),
            self.place(last, 0.3 if first == last else 0.5),
        )
        if begin == goal:
            return None
        # circles that nothing crosses are not crossed either, and other sides than pieces cost nothing
        price = np.append(np.where(self.edges < len(self.drawing.at), crossing * self.face, np.inf), 0.0)
        for edge in (first, last):
            price[self.first[edge] : self.first[edge + 1]] = np.inf
        for edge in strand.inner[:-1]:
            price[self.first[edge] : self.first[edge + 1]] = 0.0
        price[begin + 1 : self.first[first + 1]] = 0.0
        price[self.first[last] : goal] = 0.0
        self.graph.data = self.length + price[self.piece]
        starts, goals = (self.leave[self.piece == each] for each in (begin, goal))
        if not len(starts) or not len(goals):
            return None
        most = crossing * self.face * len(strand.inner)
        distance, before, _ = dijkstra(self.graph, indices=starts, return_predecessors=True, min_only=True, limit=most)
        way = [int(goals[np.argmin(distance[goals])])]
        if np.isinf(distance[way[0]]):
            return None
        while before[way[-1]] >= 0:
            way.append(int(before[way[-1]]))
        count, here = self.graph.shape[0], np.array(way[::-1])
        gates = np.searchsorted(self.leave * count + self.enter, here[:-1] * count + here[1:])
        tips = [self.points[self.pieces[each]].mean(axis=0) for each in (begin, goal)]
        route = self.dart[gates[price[self.piece[gates]] > 0.0]].tolist()
        return Way((start, end), np.array([tips[0], *self.middle[gates], tips[1]]), route)
