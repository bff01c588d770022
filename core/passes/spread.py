"""A drawing is spread: strands that have come near each other move apart, and no new crossings appear.

Vertices and crossings are corners of triangles.  Wherever each corner inside is an average of its neighbours with
positive weights, no triangle is turned over (Tutte 1963; Floater, *Math. Comp.* 72, 2003).  The drawing as it is has
mean value coordinates as weights; the weights of springs, stiffened until all are about equally long, spread it, and
averages of both weights lead there (Floater and Gotsman, *J. Comput. Appl. Math.* 101, 1999).
"""

from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ..types import FloatArray, IntArray
from .drawing import Drawing
from .moving import MovingCurve
from .triangles import Triangles

_STIFFENINGS = 20
_PARTS = 64  # of the way, the shortest that are tried
_ASIDE = 0.05  # of the shortest edge at a crossing
_FLAT = 1e-9  # least value that 1 + cos α is taken to have
_RING = 32  # points around the drawing, which stay where they are,
_AROUND = 1.2  # so many times as far from its middle as its farthest point


def spread(body: MovingCurve, drawing: Drawing) -> bool:
    """Even out a curve's drawing; return whether that was proved free.  Crossings become vertices of both strands."""
    layout = _Layout(drawing)
    node = _nodes(body, drawing)
    if node is None:
        return False

    def on_the_way(part: int) -> FloatArray:
        return np.column_stack([_parted(body, node, layout.between(part / _PARTS)), body.seen[:, 2]])

    return body.follow(np.arange(body.mesh.size), on_the_way, _PARTS)


def _parted(body: MovingCurve, node: IntArray, layout: FloatArray) -> FloatArray:
    """The vertices on their nodes, but one of both at a crossing slightly aside, so that edges cross inside, and once.

    It moves along the bisector of its way in and the nearer branch of the other strand.
    """
    places, before, after = layout[node], body.mesh.anticycle, body.mesh.cycle
    order = np.argsort(node, kind="stable")
    twice = np.flatnonzero(node[order][1:] == node[order][:-1])
    stays, goes = order[twice], order[twice + 1]

    def toward(vertices: IntArray) -> tuple[FloatArray, FloatArray]:
        vectors = places[vertices] - places[goes]
        lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
        return vectors / lengths, lengths

    (one, a), (other, b), (come, c), (_, d) = map(toward, (before[stays], after[stays], before[goes], after[goes]))
    nearer = np.einsum("ij,ij->i", one, come) > np.einsum("ij,ij->i", other, come)
    aside = come + np.where(nearer[:, None], one, other)
    places[goes] += _ASIDE * np.minimum(np.minimum(a, b), np.minimum(c, d)) * aside
    return places


def _nodes(body: MovingCurve, drawing: Drawing) -> IntArray | None:
    """Insert vertices at all crossings; return the node of the drawing that each vertex is."""
    n = drawing.mesh.size
    passes = zip(drawing.at, drawing.diagram.sequence, strict=True)
    places = sorted((at, n + crossing) for at, (crossing, _) in passes if crossing >= 0)
    at = np.array([at for at, _ in places])
    if not body.insert(at):
        return None
    return np.insert(np.arange(n), np.floor(at).astype(np.intp) + 1, [node for _, node in places])


class _Layout:
    """The drawing as it is, spread, and everything in between: places of the nodes in the plane."""

    def __init__(self, drawing: Drawing) -> None:
        nodes = drawing.nodes
        self.count = len(nodes)
        middle = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
        radius = _AROUND * np.linalg.norm(nodes - middle, axis=1).max()
        turn = 2.0 * np.pi * np.arange(_RING) / _RING
        self.ring = middle + radius * np.column_stack([np.cos(turn), np.sin(turn)])
        points = np.concatenate([nodes, self.ring])
        walls = [(self.count + k, self.count + (k + 1) % _RING) for k in range(_RING)]
        for _, chain in drawing.chains():
            walls += pairwise(chain)
        corners = Triangles(points, walls).corners
        corners = corners[(corners < len(points)).all(axis=1)]
        self.now = _mean_values(points, corners)
        self.spread = self._springs(corners)

    def between(self, part: float) -> FloatArray:
        """The nodes on the way from the drawing as it is, 0, to the one that is spread, 1."""
        return self._placed((1.0 - part) * self.now + part * self.spread)[: self.count]

    def _placed(self, weights: sp.csr_array) -> FloatArray:
        """All points, with those inside as averages of their neighbours; the rows of ``weights`` sum to 1."""
        inside = weights[: self.count]
        matrix = (sp.eye_array(self.count) - inside[:, : self.count]).tocsc()
        return np.concatenate([splu(matrix).solve(inside[:, self.count :] @ self.ring), self.ring])

    def _springs(self, corners: IntArray) -> sp.csr_array:
        """Weights with which all edges are about equally long."""
        size = self.count + _RING
        sides = np.unique(
            np.sort(np.concatenate([corners, np.roll(corners, -1, axis=1)]).reshape(2, -1).T, axis=1), axis=0
        )
        stiff = np.ones(len(sides))
        for _ in range(_STIFFENINGS):
            form = sp.coo_array((stiff, sides.T), shape=(size, size)).tocsr()
            weights = _normalised(form + form.T)
            points = self._placed(weights)
            length = np.linalg.norm(points[sides[:, 0]] - points[sides[:, 1]], axis=1)
            stiff *= np.sqrt(length / length.mean())
        return weights


def _mean_values(points: FloatArray, corners: IntArray) -> sp.csr_array:
    """Mean value coordinates of each point with respect to its neighbours: (tan α/2 + tan β/2)/|x − y|."""
    rows, columns, values = [], [], []
    for turn in range(3):
        at, one, other = np.roll(corners, -turn, axis=1).T
        u, v = points[one] - points[at], points[other] - points[at]
        long, wide = np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)
        both = long * wide
        # tan(α/2) = sin α/(1 + cos α)
        half = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / np.maximum(both + np.einsum("ij,ij->i", u, v), _FLAT * both)
        rows += [at, at]
        columns += [one, other]
        values += [half / long, half / wide]
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return _normalised(sp.coo_array(entries, shape=(len(points), len(points))).tocsr())


def _normalised(weights: sp.csr_array) -> sp.csr_array:
    return (sp.diags_array(1.0 / weights.sum(axis=1)) @ weights).tocsr()
