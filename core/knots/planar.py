"""Knots and links from diagrams, which are drawn with straight lines, and their crossings lifted into space.

Crossings, edges and faces of a diagram become nodes of a triangulated disk, which Tutte's theorem (*How to draw a
graph*, 1963) draws without overlaps for any positive weights; weights that grow with lengths make the drawing even.
"""

from collections.abc import Sequence
from itertools import chain

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from ..arguments import checked
from ..collision import check_embedded
from ..curve import Curve, refine
from ..curve.curve import MAKERS
from ..diagrams import Diagram, PlanarCrossing, diagram_of
from ..diagrams.codes import diagram_from_code
from ..diagrams.rerouting import without_nugatory
from ..errors import CurveError
from ..types import FloatArray
from .inscribed import MAX_VERTICES

_ROUNDS = 4  # in which weights grow with the square roots of lengths; with many more some lines collapse
_LIFT = 0.5  # of the shortest line from a crossing: the height of its strands above and below the plane
_CIRCLE = 12  # vertices of a component without crossings
_GAP = 0.5  # between parts that no crossing joins, all of radius 1


@checked
def diagram_knot(code: Sequence[PlanarCrossing], vertices: int | None = None) -> Curve:
    """Make the knot or link of a planar diagram code as a polygon with four vertices for every crossing, or more.

    The code has for each crossing its four edges, counterclockwise from the one that comes in below; nugatory crossings
    are left out.  Raises CurveError if there is no such diagram, or the vertices are too few or too many.

    >>> len(diagram_knot([(1, 5, 2, 4), (3, 1, 4, 6), (5, 3, 6, 2)]))
    12
    """
    return _refined(drawn(diagram_of(code)), vertices)


@checked
def coded_knot(text: str, vertices: int | None = None, kind: str | None = None) -> Curve:
    """Make the knot or link of a PD, DT or Gauss code, read by `diagram_from_code`, as :func:`diagram_knot` does."""
    return _refined(drawn(diagram_from_code(text, kind)), vertices)


def drawn(diagram: Diagram) -> Curve:
    """A polygon that looks like a diagram from above, nugatory crossings left out; its parts lie side by side."""
    parts: list[FloatArray] = []
    for k, piece in enumerate(without_nugatory(diagram).pieces()):
        parts += [part + (2.0 + _GAP) * k * np.eye(3)[0] for part in _drawn_piece(piece)]
    curve = Curve.from_components(parts)
    check_embedded(curve)
    return curve


def _of_link(other: object) -> Curve | None:
    """The drawing of an object that has a planar diagram code, or is made from one that has; None for others."""
    makes_link = getattr(other, "link", None)  # as SnapPy's manifolds do
    try:
        link = makes_link() if callable(makes_link) and not hasattr(other, "PD_code") else other
    except ValueError as error:
        raise CurveError(f"{str(other)[:60]} has no link: {str(error)[:200]}") from error
    code_of = getattr(link, "PD_code", None)
    if not callable(code_of):
        return None
    code = [tuple(map(int, edges)) for edges in code_of()]
    diagram = diagram_of(code) if code else Diagram((), ())
    circles = int(getattr(link, "unlinked_unknot_components", 0) or not code)  # which the code does not have
    return drawn(Diagram((*diagram.passes, *((),) * circles), diagram.signs))


MAKERS.append(_of_link)


def _refined(curve: Curve, vertices: int | None) -> Curve:
    if vertices is None:
        return curve
    if not len(curve) <= vertices <= MAX_VERTICES:
        few = "few" if vertices < len(curve) else "many"
        raise CurveError(f"{vertices} vertices are too {few} for this diagram; give {len(curve)} to {MAX_VERTICES}")
    return refine(curve, vertices)


def _drawn_piece(piece: Diagram) -> list[FloatArray]:
    """The components of a connected diagram, each from after its first lower pass on; vertices of shape (n, 3)."""
    if not piece.crossings:
        angle = 2.0 * np.pi * np.arange(_CIRCLE) / _CIRCLE
        return [np.column_stack([np.cos(angle), np.sin(angle), np.zeros(_CIRCLE)])]
    places, middles = _drawing(piece)
    lift = _LIFT * np.linalg.norm(middles[np.array(piece.planar_code)] - places[:, None], axis=2).min(axis=1)
    crossing, over = np.array(piece.sequence).T
    points = np.zeros((len(crossing), 2, 3))  # for each pass its crossing, and the middle of the edge after it
    points[:, 0] = np.column_stack([places[crossing], np.where(over, lift[crossing], -lift[crossing])])
    points[:, 1, :2] = middles
    starts: dict[int, int] = {}
    for start in chain(*zip(*piece.levels, strict=True)):
        starts.setdefault(piece.component[start], start)
    component, parts = np.array(piece.component), []
    for k, start in starts.items():
        own = np.flatnonzero(component == k)
        parts.append(points[np.roll(own, own[0] - start - 1)].reshape(-1, 3))
    return parts


def _drawing(piece: Diagram) -> tuple[FloatArray, FloatArray]:
    """Places in the plane of crossings and middles of edges, those of the longest face on a circle; shapes (n, 2)."""
    code, count = piece.planar_code, piece.crossings
    node = {edge: count + k for k, edge in enumerate(dict.fromkeys(chain(*code)))}
    begins = [crossing for crossing, _ in piece.sequence]
    faces = []
    for face in piece.faces:
        ends = (piece.next[dart // 2] if dart % 2 else dart // 2 for dart in face)
        faces.append([each for end, dart in zip(ends, face, strict=True) for each in (begins[end], node[dart // 2])])
    outer = max(faces, key=len)
    inner = [face for face in faces if face is not outer]
    halves = [(node[edge], c) for c, edges in enumerate(code) for edge in edges]
    spokes = [(3 * count + f, each) for f, face in enumerate(inner) for each in face]
    tails, heads = np.array(halves + spokes).T
    angles = -2 * np.pi * np.arange(len(outer)) / len(outer)  # the outer face is on its left
    points = np.zeros((3 * count + len(inner), 2))
    points[outer] = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    inside = np.ones(len(points), dtype=bool)
    inside[outer] = False
    weights = np.ones(len(tails))
    for _ in range(_ROUNDS):
        both_ways = np.r_[tails, heads], np.r_[heads, tails]
        adjacency = sp.coo_array((np.r_[weights, weights], both_ways), shape=(len(points), len(points)))
        rows = (sp.diags_array(adjacency.sum(axis=1)) - adjacency).tocsc()[inside]  # of the Laplacian
        points[inside] = spsolve(rows[:, inside], -rows[:, ~inside] @ points[~inside])
        lengths = np.linalg.norm(points[tails] - points[heads], axis=1)
        weights *= np.sqrt(lengths / lengths.mean())
    return points[:count], points[[node[edge] for edge in range(2 * count)]]
