"""Knots and links from planar diagram codes: the diagram drawn with straight lines, its crossings lifted into space.

A code lists for every crossing its four edges, counterclockwise from the one that comes in below.  Crossings, edges
and faces become nodes of a triangulated disk, which Tutte's theorem (*How to draw a graph*, 1963) draws without
overlaps for any positive weights; weights that grow with lengths make the drawing even.
"""

from collections.abc import Iterator, Sequence

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from ..arguments import checked
from ..curve import Curve, refine
from ..diagrams import PlanarCrossing as Crossing
from ..errors import CurveError
from ..types import FloatArray, IntArray
from .rings import MAX_VERTICES

_Dart = tuple[int, int]  # a crossing, and the place from 0 to 3 of an edge that leaves it

_ROUNDS = 4  # in which weights grow with the square roots of lengths; with many more some lines collapse
_LIFT = 0.5  # of the shortest line from a crossing: the height of its strands above and below the plane


@checked
def diagram_knot(code: Sequence[Crossing], vertices: int | None = None) -> Curve:
    """Make the knot or link of a planar diagram code as a polygon with four vertices for every crossing, or more.

    Parameters
    ----------
    code
        Of a diagram that hangs together, with no crossing that could be undone by turning over one side of it.
    vertices
        Total number of vertices.

    Raises
    ------
    CurveError
        If it is no such code, or the vertices are too few or too many.

    Examples
    --------
    >>> len(diagram_knot([(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)]))
    12
    """
    diagram = _Diagram(code)
    points = diagram.drawing()
    count = len(code)
    parts: list[list[tuple[float, float, float]]] = []
    for passes in diagram.components():
        path: list[tuple[float, float, float]] = []
        for crossing, place in passes:
            near = points[[count + diagram.edges[label] for label in code[crossing]]]
            lift = _LIFT * float(np.linalg.norm(near - points[crossing], axis=1).min())
            x, y = points[crossing]
            path += [(x, y, lift if place % 2 else -lift), (*near[(place + 2) % 4], 0.0)]
        parts.append(path)
    curve = Curve.from_components(parts)
    if vertices is None:
        return curve
    if not len(curve) <= vertices <= MAX_VERTICES:
        few = "few" if vertices < len(curve) else "many"
        raise CurveError(f"{vertices} vertices are too {few} for this diagram; give {len(curve)} to {MAX_VERTICES}")
    return refine(curve, vertices)


class _Diagram:
    """The cells of a diagram on the sphere; nodes are numbered crossings first, then edges, then inner faces."""

    def __init__(self, code: Sequence[Crossing]) -> None:
        darts: dict[int, list[_Dart]] = {}
        for c, crossing in enumerate(code):
            for place, label in enumerate(crossing):
                darts.setdefault(label, []).append((c, place))
        self._code, self.edges = code, {label: k for k, label in enumerate(darts)}
        if len(code) < 2 or any(len(crossing) != 4 for crossing in code) or any(len(d) != 2 for d in darts.values()):
            raise CurveError("a planar diagram code has 2 or more crossings of 4 edges, and every edge twice")
        self._mate = {dart: other for pair in darts.values() for dart, other in (pair, pair[::-1])}
        faces = list(self._faces())
        if len(faces) != len(code) + 2:
            raise CurveError("the planar diagram code cannot be drawn in the plane, or falls apart")
        if any(len(set(face)) < len(face) for face in faces):
            raise CurveError(
                "the planar diagram code has a crossing that a turn of one side of it undoes; leave it out"
            )
        self._outer = max(faces, key=len)
        self._inner = [face for face in faces if face is not self._outer]

    def components(self) -> Iterator[list[_Dart]]:
        """Follow each component: the crossings that it comes to, and the places where it comes in."""
        left = dict.fromkeys((crossing, place) for place in (2, 1) for crossing in range(len(self._code)))
        while left:
            passes: list[_Dart] = []
            dart = start = next(iter(left))
            while not passes or dart != start:
                crossing, place = self._mate[dart]
                passes.append((crossing, place))
                dart = crossing, (place + 2) % 4
                for seen in (dart, (crossing, place)):
                    left.pop(seen, None)
            yield passes

    def drawing(self) -> FloatArray:
        """Positions of all nodes in the plane, the outer face's on a circle; shape (nodes, 2)."""
        tails, heads = self._lines().T
        weights = np.ones(len(tails))
        for _ in range(_ROUNDS):
            points = self._balanced(tails, heads, weights)
            lengths = np.linalg.norm(points[tails] - points[heads], axis=1)
            weights *= np.sqrt(lengths / lengths.mean())
        return points

    def _balanced(self, tails: IntArray, heads: IntArray, weights: FloatArray) -> FloatArray:
        """Put every inner node into the weighted mean of its neighbours."""
        size = 3 * len(self._code) + len(self._inner)
        adjacency = sp.coo_array(
            (np.r_[weights, weights], (np.r_[tails, heads], np.r_[heads, tails])), shape=(size, size)
        )
        laplacian = (sp.diags_array(adjacency.sum(axis=1)) - adjacency).tocsc()
        inner = np.ones(size, dtype=bool)
        inner[self._outer] = False
        angles = -2 * np.pi * np.arange(len(self._outer)) / len(self._outer)  # the outer face is on its left
        points = np.zeros((size, 2))
        points[self._outer] = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        rows = laplacian[inner]
        points[inner] = spsolve(rows[:, inner], -rows[:, ~inner] @ points[~inner])
        return points

    def _lines(self) -> IntArray:
        """The edges of the triangulation: from edges to crossings, and from faces to both; shape (lines, 2)."""
        count = len(self._code)
        halves = [(count + self.edges[label], c) for c, crossing in enumerate(self._code) for label in crossing]
        spokes = [(3 * count + f, node) for f, face in enumerate(self._inner) for node in face]
        return np.array(halves + spokes)

    def _faces(self) -> Iterator[list[int]]:
        """The nodes round each face, crossings and edges by turns, the face on the left."""
        unseen = dict.fromkeys(self._mate)
        while unseen:
            face, dart = [], next(iter(unseen))
            while dart in unseen:
                del unseen[dart]
                crossing, place = dart
                face += [crossing, len(self._code) + self.edges[self._code[crossing][place]]]
                crossing, place = self._mate[dart]
                dart = crossing, (place - 1) % 4
            yield face
