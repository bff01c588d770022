"""Refuse curves that touch themselves or obstacles, and say where; and check that they survive rounding."""

from collections.abc import Iterator, Sequence

import numpy as np

from ..base.errors import CurveError
from ..base.messages import COMPONENT, EDGE, VERTEX, Message
from ..base.tolerances import MIN_GAP, MIN_SPACING, ON_EDGE_UNITS, PLANE_ROUNDING
from ..base.types import BoolArray, FloatArray, IntArray
from ..curve import Curve, Mesh, Obstacle, at_edges, at_vertices
from .boxes import BoxTree, Level, corners, still_triangles
from .exact import EDGES, crossing, first_contact
from .gap import folds, minimal_gap, near_edges, scaled_points, squared_gaps, squared_segment_distances, written
from .planes import doubtful

TOUCHING = Message("{edge} and {other} touch or cross near {place}; move the strands apart")
DOUBTFUL = Message(
    "{edge} and {other}, near {place}, and thousands of others are so close that rounding hides whether they touch; "
    "move the strands apart"
)
PIERCES = Message("{edge} pierces {obstacle} at {place}; move one of them away")
TOUCHES = Message("{edge} touches {obstacle} at {place}; move one of them away")
TOO_NEAR = Message("{edge} comes too near to {obstacle} at {place}; move one of them away")


def check_embedded(curve: Curve) -> None:
    """Raise unless the curve is embedded: no repeated points, no doubled-back edges, no edges that touch or cross.

    Exact in the plane and in space.  In four and more dimensions, where nothing is proved, edges touch if they are
    together up to rounding.  The CurveError names component, edges and vertices, and the place.
    """
    tails, heads = curve.mesh.tails, curve.mesh.heads
    unit = int(np.frexp(np.abs(curve.vertices).max())[1]) + 1  # differences of scaled coordinates don't overflow
    points = np.ldexp(curve.vertices, -unit)
    nearest = MIN_SPACING * np.ptp(points, axis=0).max()
    same = np.flatnonzero((np.abs(points[heads] - points[tails]) <= nearest).all(axis=1))
    if same.size:
        tail, head = int(tails[same[0]]), int(heads[same[0]])
        same_point = "{vertex} and {other} are the same point {place}; remove one of them"
        ends = {"vertex": _name(curve.mesh, VERTEX, tail), "other": _name(curve.mesh, VERTEX, head)}
        message = Message(same_point, **ends, place=written(curve.vertices[tail]))
        raise CurveError(message, at_vertices(curve, tail, head))
    points, _ = scaled_points(curve)
    # the curve must not turn by 180° at a vertex, up to rounding
    mesh = curve.mesh
    before = np.flatnonzero(mesh.next != np.arange(mesh.edges))
    after = mesh.next[before]
    vectors = points[:, mesh.heads] - points[:, mesh.tails]
    first, second = vectors[:, before], vectors[:, after]
    p, q = np.triu_indices(len(points), 1)
    left, right = first[p] * second[q], first[q] * second[p]
    parallel = (np.abs(left - right) <= PLANE_ROUNDING * (np.abs(left) + np.abs(right))).all(axis=0)
    bad = np.flatnonzero(parallel & (np.einsum("mn,mn->n", first, second) < 0))
    if bad.size:
        vertex = int(mesh.tails[after[bad[0]]])
        back = "the curve doubles back at {vertex}, {place}; move or remove it"
        message = Message(back, vertex=_name(mesh, VERTEX, vertex), place=written(curve.vertices[vertex]))
        raise CurveError(message, at_vertices(curve, vertex))
    touching = _touching_pairs if curve.dimension <= 3 else _coinciding_pairs
    for i, j in touching(curve, points):
        raise _refusal(TOUCHING, curve, i, j)


def _touching_pairs(curve: Curve, points: FloatArray) -> Iterator[tuple[int, int]]:
    """Pairs of edges that touch, sorted batch by batch; raises a CurveError if too many pairs are doubtful.

    Pairs are doubtful if no plane separates them certainly in floating-point numbers; these are decided exactly.  Never
    all at once: where thousands of edges coincide there are millions, and the first is enough.  No comparison of boxes
    is rounded: a gap has the sign of the exact difference.
    """
    tree, mesh, count = BoxTree.build(curve.mesh, points, points), curve.mesh, 0

    def near(level: Level, a: IntArray, other: Level, b: IntArray) -> BoolArray:
        return np.asarray((level.gaps(a, other, b)[0] <= 0).all(axis=0))

    for a, b in tree.pairs(near):
        pairs = np.sort(tree.order[np.stack([a, b])], axis=0)
        for i, j in sorted(pairs[:, doubtful(points, corners(mesh, *pairs))].T.tolist()):
            ends = curve.vertices[corners(mesh, i, j)]  # as given: scaling may cost the smallest digits
            if first_contact(ends, ends) is not None:
                yield i, j
            if count == 2000:  # that take about a second; `check_gap` refuses strands that need more, if not this
                raise _refusal(DOUBTFUL, curve, i, j)
            count += 1


def _coinciding_pairs(curve: Curve, points: FloatArray) -> Iterator[tuple[int, int]]:
    """Pairs of edges no further apart than rounding, sorted batch by batch."""
    nearest = MIN_SPACING * float(np.ptp(points, axis=1).max())
    for i, j, _ in near_edges(curve, points, lambda: nearest**2):
        yield from sorted(zip(*np.sort(np.stack([i, j]), axis=0).tolist(), strict=True))


def meeting_point(ends: FloatArray) -> FloatArray:
    """Return a point of the first edge near the second, for a message; ``ends`` has shape (4, m)."""
    x0, x1, y0, y1 = ends
    x = x0 + np.linspace(0.0, 1.0, 257)[:, None] * (x1 - x0)
    f = y1 - y0
    r = ((x - y0) @ f / max(f @ f, np.finfo(np.float64).tiny)).clip(0.0, 1.0)
    return np.asarray(x[np.linalg.norm(x - y0 - r[:, None] * f, axis=1).argmin()])


def _name(mesh: Mesh, kind: str, number: int) -> Message:
    """What messages call an edge or a vertex: ``kind`` is EDGE or VERTEX."""
    components, offsets = (mesh.edge_component, mesh.edge_offsets) if kind == EDGE else (mesh.component, mesh.offsets)
    c = int(components[number])
    part = Message(kind, number=number - int(offsets[c]) + 1)
    return Message("{part} of {component}", part=part, component=Message(COMPONENT, number=c + 1))


def _refusal(template: str, curve: Curve, i: int, j: int) -> CurveError:
    """The sentence about two edges and the place where they meet."""
    where = meeting_point(curve.vertices[corners(curve.mesh, i, j)])
    edges = {"edge": _name(curve.mesh, EDGE, i), "other": _name(curve.mesh, EDGE, j)}
    return CurveError(Message(template, **edges, place=written(where)), at_edges(curve, (i, j), where))


def check_clear(curve: Curve, obstacles: Sequence[Obstacle]) -> None:
    """Refuse a curve that touches obstacles or comes too near to them to compute with; inside a closed one it may be.

    A CurveError says so, naming edge, obstacle and place; another if there are obstacles and the curve is not in
    space.
    """
    if not obstacles:
        return
    if curve.dimension != 3:
        raise CurveError(
            f"the curve has dimension {curve.dimension}, but obstacles are in space; "
            "give its vertices three coordinates, or leave the obstacles out"
        )
    for edge, pair, obstacle in _near(curve, obstacles, MIN_GAP * curve.length):
        what, where = _meeting(pair)
        reason = Message(what, edge=_name(curve.mesh, EDGE, edge), obstacle=obstacle.title, place=written(where))
        raise CurveError(reason, at_edges(curve, (edge,), where))


def clears(curve: Curve, obstacles: Sequence[Obstacle], distance: float) -> bool:
    """Whether a curve that is clear of obstacles is certainly further from them than a distance."""
    return not obstacles or next(_near(curve, obstacles, distance), None) is None


def _near(curve: Curve, obstacles: Sequence[Obstacle], distance: float) -> Iterator[tuple[int, FloatArray, Obstacle]]:
    """Edges and obstacles not certainly further apart than a distance, with the pairs' vertices, shape (5, 3).

    Certainly except for the rounding of distances, a few units of the last place: whatever relies on it leaves more.
    """
    exponent = int(np.frexp(max(np.abs(curve.vertices).max(), *(each.size for each in obstacles)))[1])
    still = still_triangles(tuple(obstacles), exponent)
    given = np.concatenate([curve.vertices, still.vertices])
    points, radius = np.ldexp(given.T, -exponent, order="C"), float(np.ldexp(distance, -exponent))
    own = points[:, : len(curve)]
    tree = BoxTree.build(curve.mesh, own, own)

    def near(level: Level, a: IntArray, other: Level, b: IntArray) -> BoolArray:
        return squared_gaps(level.gaps(a, other, b)) <= radius**2

    for a, b in tree.pairs_with(still.tree, near):
        vertices = np.concatenate([tree.corners[:, a], len(curve) + still.tree.corners[:, b]])
        close = np.flatnonzero(doubtful(points, vertices, radius))
        for k in close[np.argsort(tree.order[a[close]], kind="stable")].tolist():
            yield int(tree.order[a[k]]), given[vertices[:, k]], still.obstacle_of(int(still.tree.order[b[k]]))


def _meeting(corners: FloatArray) -> tuple[str, FloatArray]:
    """What an edge does to a nearby triangle, and where; ``corners`` has shape (5, 3)."""
    s = crossing(corners[0], corners[1], corners[2:])
    if s is not None:
        return (PIERCES if 0 < s < 1 else TOUCHES), corners[0] + s * (corners[1] - corners[0])
    touched = [four for four in (corners[[0, 1, *ends]] for ends in EDGES) if first_contact(four, four) is not None]
    if touched:
        return TOUCHES, meeting_point(touched[0])
    return TOO_NEAR, np.asarray(corners[:2].mean(axis=0))


def survives_rounding(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> bool:
    """Whether vertices that lie on edges up to rounding can move onto these without any contact.

    Then the curve with them and the curve without them are isotopic: no point moves by more than r, the rounding, and
    what must not meet, edges that are no neighbours and `folds`, is more than 2 r apart, and obstacles, which the curve
    does not touch, more than r from it (and a bit, for the rounding of that distance). In more than three dimensions
    there is nothing to keep.
    """
    if curve.dimension > 3:
        return True
    rounding = ON_EDGE_UNITS * np.spacing(np.abs(curve.vertices).max()) * np.sqrt(curve.dimension)
    points, unit = scaled_points(curve)
    fold = np.sqrt(np.min(squared_segment_distances(points, folds(curve.mesh)), initial=np.inf))
    nearest = min(minimal_gap(curve)[0], float(np.ldexp(fold, unit)))
    return bool(nearest > 2.1 * rounding) and clears(curve, obstacles, float(1.1 * rounding))
