"""Refuse curves that touch themselves, and say where."""

from collections.abc import Iterator

import numpy as np

from ..curve import Curve, Mesh
from ..curve.places import at_edges, at_vertices
from ..errors import CurveError
from ..messages import COMPONENT, EDGE, EDGES, VERTEX, VERTICES, Message
from ..types import BoolArray, FloatArray, IntArray
from .boxes import BoxTree, Level, corners
from .exact import first_contact
from .gap import near_edges, scaled_points
from .planes import ROUNDING, Separation, closest_chord, relative_motion

MIN_SPACING = 2.0**-48  # of neighbours, relative to the curve's size; nearer ones are the same up to rounding

TOUCHING = Message("{edges} touch or cross near {place}; move the strands apart")
DOUBTFUL = Message(
    "{edges}, near {place}, and thousands of others are so close that rounding hides whether they touch; "
    "move the strands apart"
)
_DECISIONS = 2000  # exact ones, about a second: strands that need more are refused by `check_gap`, if not here


def check_embedded(curve: Curve) -> None:
    """Raise unless the curve is embedded: no repeated points, no doubled-back edges, no edges that touch or cross.

    Exact in the plane and in space.  In four and more dimensions, where nothing is proved, edges touch if they are
    together up to rounding.

    Raises
    ------
    CurveError
        One sentence that names the component and its edges and vertices, counted from 1, and the place.
    """
    _check_repeated(curve)
    points, _ = scaled_points(curve)
    _check_doubled_back(curve, points)
    _check_crossings(curve, points)


def _check_repeated(curve: Curve) -> None:
    tails, heads = curve.mesh.tails, curve.mesh.heads
    unit = int(np.frexp(np.abs(curve.vertices).max())[1]) + 1  # differences of scaled coordinates don't overflow
    points = np.ldexp(curve.vertices, -unit)
    nearest = MIN_SPACING * np.ptp(points, axis=0).max()
    same = np.flatnonzero((np.abs(points[heads] - points[tails]) <= nearest).all(axis=1))
    if same.size:
        tail, head = int(tails[same[0]]), int(heads[same[0]])
        (component, j), (_, k) = numbered_vertex(curve.mesh, tail), numbered_vertex(curve.mesh, head)
        reason = Message(
            "{component}: {vertices} are the same point {place}; remove one of them",
            component=component,
            vertices=Message(VERTICES, first=j, second=k),
            place=written(curve.vertices[tail]),
        )
        raise CurveError(reason, at_vertices(curve, tail, head))


def _check_doubled_back(curve: Curve, points: FloatArray) -> None:
    """Find vertices where the curve turns by 180°, up to rounding."""
    mesh = curve.mesh
    before = np.flatnonzero(mesh.next != np.arange(mesh.edges))
    after = mesh.next[before]
    vectors = points[:, mesh.heads] - points[:, mesh.tails]
    first, second = vectors[:, before], vectors[:, after]
    p, q = np.triu_indices(len(points), 1)
    left, right = first[p] * second[q], first[q] * second[p]
    parallel = (np.abs(left - right) <= ROUNDING * (np.abs(left) + np.abs(right))).all(axis=0)
    bad = np.flatnonzero(parallel & (np.einsum("mn,mn->n", first, second) < 0))
    if bad.size:
        i, j = int(after[bad[0]]), int(before[bad[0]])
        vertex = int(mesh.tails[i])
        (component, k), (_, previous), (_, place) = numbered(mesh, i), numbered(mesh, j), numbered_vertex(mesh, vertex)
        reason = Message(
            "{component}: {edge} doubles back on {previous} at {vertex}, {place}; move or remove it",
            component=component,
            edge=Message(EDGE, number=k),
            previous=Message(EDGE, number=previous),
            vertex=Message(VERTEX, number=place),
            place=written(curve.vertices[vertex]),
        )
        raise CurveError(reason, at_vertices(curve, vertex))


def _check_crossings(curve: Curve, points: FloatArray) -> None:
    touching = _touching_pairs if curve.dimension <= 3 else _coinciding_pairs
    for i, j in touching(curve, points):
        raise _refusal(TOUCHING, curve, i, j)


def _touching_pairs(curve: Curve, points: FloatArray) -> Iterator[tuple[int, int]]:
    """Pairs of edges that touch, decided exactly; raises a CurveError where more pairs are doubtful than can be."""
    for count, (i, j) in enumerate(_doubtful_pairs(curve.mesh, points)):
        ends = curve.vertices[corners(curve.mesh, i, j)]  # as given: scaling may cost the smallest digits
        if first_contact(ends, ends) is not None:
            yield i, j
        if count == _DECISIONS:
            raise _refusal(DOUBTFUL, curve, i, j)


def _coinciding_pairs(curve: Curve, points: FloatArray) -> Iterator[tuple[int, int]]:
    """Pairs of edges no further apart than rounding, sorted batch by batch."""
    nearest = MIN_SPACING * float(np.ptp(points, axis=1).max())
    for i, j, _ in near_edges(curve, points, lambda: nearest**2):
        yield from sorted(zip(*np.sort(np.stack([i, j]), axis=0).tolist(), strict=True))


def _doubtful_pairs(mesh: Mesh, points: FloatArray) -> Iterator[tuple[int, int]]:
    """Pairs of edges that no plane separates certainly in floating-point numbers, sorted batch by batch.

    Never all at once: where thousands of edges coincide they are millions, and the first is enough. No comparison of
    boxes is rounded: a gap has the sign of the exact difference.
    """
    tree = BoxTree.build(mesh, points, points)

    def near(level: Level, a: IntArray, other: Level, b: IntArray) -> BoolArray:
        return np.asarray((level.gaps(a, other, b)[0] <= 0).all(axis=0))

    for a, b in tree.pairs(near):
        i, j = np.sort(tree.order[np.stack([a, b])], axis=0)
        motion = relative_motion(points, points, corners(mesh, i, j))
        planes = Separation(motion, np.abs(motion).sum(axis=1), closest_chord(motion[0]))
        doubtful = ~planes.proves(np.zeros(len(i)))
        yield from sorted(zip(i[doubtful].tolist(), j[doubtful].tolist(), strict=True))


def meeting_point(ends: FloatArray) -> FloatArray:
    """Return a point of the first edge near the second, to be named in a message; ``ends`` has shape (4, m)."""
    x0, x1, y0, y1 = ends
    x = x0 + np.linspace(0.0, 1.0, 257)[:, None] * (x1 - x0)
    f = y1 - y0
    r = ((x - y0) @ f / max(f @ f, np.finfo(np.float64).tiny)).clip(0.0, 1.0)
    return np.asarray(x[np.linalg.norm(x - y0 - r[:, None] * f, axis=1).argmin()])


def numbered(mesh: Mesh, edge: int) -> tuple[Message, int]:
    """Component of an edge, as messages name it, and its number there, from 1."""
    c = int(mesh.edge_component[edge])
    return Message(COMPONENT, number=c + 1), edge - int(mesh.edge_offsets[c]) + 1


def numbered_vertex(mesh: Mesh, vertex: int) -> tuple[Message, int]:
    """The same of a vertex."""
    c = int(mesh.component[vertex])
    return Message(COMPONENT, number=c + 1), vertex - int(mesh.offsets[c]) + 1


def _refusal(template: str, curve: Curve, i: int, j: int) -> CurveError:
    """The sentence about two edges and the place where they meet."""
    (c, p), (d, q) = numbered(curve.mesh, i), numbered(curve.mesh, j)
    if c == d:
        edges = Message("{component}: {edges}", component=c, edges=Message(EDGES, first=p, second=q))
    else:
        one, other = Message(EDGE, number=p), Message(EDGE, number=q)
        edges = Message("{edge} of {component} and {other} of {another}", edge=one, component=c, other=other, another=d)
    where = meeting_point(curve.vertices[corners(curve.mesh, i, j)])
    return CurveError(Message(template, edges=edges, place=written(where)), at_edges(curve, (i, j), where))


def written(position: FloatArray) -> str:
    """A point as messages have it."""
    return "(" + ", ".join(f"{x:.6g}" for x in position) + ")"
