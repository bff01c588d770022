"""Ways for strands in the plane of a drawing: across as few others as can be, and short.

The plane is cut into triangles between the nodes of the drawing and the points of a grid.  A way goes from one to the
next, and pays for pieces of the curve that it crosses.
"""

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import Delaunay, cKDTree

from ..base.types import FloatArray, IntArray
from ..knots.diagrams.rerouting import Strand
from .drawing import PlaneDrawing

CROSSING = 100.0  # faces that a way may be longer to cross one strand less


class Way(NamedTuple):
    """Where a strand leaves the rest of the curve and comes back to it, and how it may go on between these places."""

    ends: tuple[float, float]  # as tails plus fractions; the second one is behind the first
    corners: FloatArray  # shape (k, 2)
    route: list[int]  # the darts that it crosses from the left


class Plane:
    """A drawing's plane in triangles, of which pieces of the curve are sides."""

    def __init__(self, drawing: PlaneDrawing, face: float) -> None:
        self.drawing, self.face = drawing, face
        nodes = drawing.nodes
        grid = np.stack(
            np.meshgrid(*(np.arange(a - 2.0 * face, b + 2.0 * face, 0.5 * face) for a, b in zip(nodes.min(0), nodes.max(0)))), -1
        ).reshape(-1, 2)
        grid[:, 0] += 0.25 * face * (np.arange(len(grid)) % 2)
        points = np.concatenate([nodes, grid[cKDTree(nodes).query(grid)[0] > 0.3 * face]])
        ends, edge = [], []
        for k, chain in drawing.chains():
            ends += list(zip(chain[:-1], chain[1:], strict=True))
            edge += [k] * (len(chain) - 1)
        pieces, edges = np.array(ends), np.array(edge)
        for _ in range(8):  # pieces that are no sides are halved
            triangles = Delaunay(points)
            corners = triangles.simplices.astype(np.int64)
            a, b = np.roll(corners, -1, axis=1), np.roll(corners, -2, axis=1)
            keys = (a * len(points) + b).ravel()
            missing = ~(np.isin(pieces @ [len(points), 1], keys) | np.isin(pieces @ [1, len(points)], keys))
            if not missing.any():
                break
            middle = len(points) + np.arange(missing.sum())
            points = np.concatenate([points, points[pieces[missing]].mean(axis=1)])
            first = np.flatnonzero(missing) + np.arange(len(middle))
            pieces, edges = (np.repeat(each, 1 + missing, axis=0) for each in (pieces, edges))
            pieces[first, 1] = pieces[first + 1, 0] = middle
        self.points, self.pieces, self.edges = points, pieces, edges
        self.first = np.searchsorted(edges, np.arange(edges[-1] + 2))  # piece of each edge of the diagram
        # gates: from a triangle to its neighbour, through a side that runs from a to b with the triangle on its left
        inside = triangles.neighbors.ravel() >= 0
        self.leave = np.repeat(np.arange(len(corners)), 3)[inside]
        self.enter = triangles.neighbors.ravel()[inside]
        gates = np.stack([a.ravel(), b.ravel()])[:, inside]
        self.middle = points[gates].mean(axis=0)
        order = np.argsort(key := pieces @ [len(points), 1])
        self.piece = np.full(len(self.leave), -1)  # of the curve, that is crossed through each gate
        self.dart = np.full(len(self.leave), -1)
        for side, (tail, head) in enumerate((gates, gates[::-1])):
            sought = tail * len(points) + head
            at = order[np.minimum(np.searchsorted(key[order], sought), len(order) - 1)]
            found = key[at] == sought
            self.piece[found], self.dart[found] = at[found], 2 * edges[at[found]] + side
        center = points[corners].mean(axis=1)
        self.length = sum(np.linalg.norm(self.middle - center[each], axis=1) for each in (self.leave, self.enter))
        room = cKDTree(nodes).query(center)[0]
        self.length *= 1.0 + np.minimum(0.02 * (face / np.maximum(room, 1e-9 * face)) ** 2, 3.0)[self.enter]
        crossing = nodes[drawing.mesh.size :]
        tight = cKDTree(crossing).query(self.middle)[0] < 0.2 * face if len(crossing) else False
        self.cost = np.where(self.piece >= 0, CROSSING * face * (1.0 + 0.1 * tight), 0.0)
        self.count = len(corners)

    def at(self, edge: int, share: float) -> tuple[int, float]:
        """The piece at a share of an edge of the diagram, and the place of its middle on the curve."""
        pieces = np.arange(self.first[edge], self.first[edge + 1])
        ends = self.points[self.pieces[pieces]]
        length = np.cumsum(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
        k = int(np.searchsorted(length, share * length[-1]))
        part = (length[k] - 0.5 * np.linalg.norm(ends[k, 1] - ends[k, 0])) / length[-1]
        names, stops = self.drawing.stops(edge)
        along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(self.drawing.nodes[names], axis=0), axis=1))]
        return int(pieces[k]), self.drawing.wrapped(edge, float(np.interp(part * along[-1], along, stops)))

    def way(self, strand: Strand) -> Way | None:
        """The best way for a strand; None if there is none."""
        last, far = strand.inner[-1], 1e6 * self.face
        same = strand.first == last
        (begin, start), (goal, end) = self.at(strand.first, 0.7 if same else 0.5), self.at(last, 0.3 if same else 0.5)
        if begin == goal:
            return None
        price = self.cost.copy()
        by_piece = np.zeros(len(self.pieces))
        for edge in strand.inner[:-1]:
            by_piece[self.first[edge] : self.first[edge + 1]] = 1.0
        one, other = (slice(self.first[edge], self.first[edge + 1]) for edge in (strand.first, last))
        by_piece[one], by_piece[other] = -1.0, -1.0
        by_piece[begin + 1 : one.stop] = 1.0
        by_piece[other.start : goal] = 1.0
        by_piece[self.edges >= len(self.drawing.at)] = -1.0  # circles that nothing crosses
        kind = np.where(self.piece >= 0, by_piece[self.piece], 0.0)
        price = np.where(kind > 0, 0.0, np.where(kind < 0, far, self.cost)) + self.length
        graph = sp.csr_array((price, (self.leave, self.enter)), shape=(self.count, self.count))
        starts, goals = (self.leave[self.piece == each] for each in (begin, goal))
        distance, before, _ = dijkstra(graph, indices=starts, return_predecessors=True, min_only=True)
        here = int(goals[np.argmin(distance[goals])]) if len(goals) else -1
        if here < 0 or not distance[here] < far:
            return None
        triangles = [here]
        while before[triangles[-1]] >= 0:
            triangles.append(int(before[triangles[-1]]))
        triangles.reverse()
        gates = [int(np.flatnonzero((self.leave == a) & (self.enter == b))[0]) for a, b in zip(triangles, triangles[1:])]
        tips = [self.points[self.pieces[each]].mean(axis=0) for each in (begin, goal)]
        route = [int(self.dart[g]) for g in gates if self.piece[g] >= 0 and kind[g] == 0]
        return Way((start, end), np.array([tips[0], *self.middle[gates], tips[1]]), route)
