"""Refuse curves that touch themselves or obstacles, and say where; and check that they survive rounding."""

from collections.abc import Iterator, Sequence

import numpy as np

from ..base import COMPONENT, EDGE, MIN_GAP, PLANE_ROUNDING, TINY, VERTEX, CurveError, FloatArray, Message, column_dot
from ..base.tolerances import MIN_SPACING, ON_EDGE_UNITS
from ..curve import Curve, Mesh, Obstacle, at_edges, at_vertices
from .boxes import BoxTree, corners, nearer_than, still_triangles
from .exact import EDGES, crossing, first_contact
from .gap import folds, minimal_gap, near_edges, scaled_points, squared_segment_distances, written
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
    mesh, (points, _) = curve.mesh, scaled_points(curve)
    vectors, nearest = points[:, mesh.heads] - points[:, mesh.tails], MIN_SPACING * float(np.ptp(points, axis=1).max())
    same = np.flatnonzero((np.abs(vectors) <= nearest).all(axis=0))
    if same.size:
        tail, head = int(mesh.tails[same[0]]), int(mesh.heads[same[0]])
        same_point = "{vertex} and {other} are the same point {place}; remove one of them"
        ends = {"vertex": _name(mesh, VERTEX, tail), "other": _name(mesh, VERTEX, head)}
        message = Message(same_point, **ends, place=written(curve.vertices[tail]))
        raise CurveError(message, at_vertices(curve, tail, head))
    # the curve must not turn by 180° at a vertex, up to rounding
    before = np.flatnonzero(mesh.next != np.arange(mesh.edges))
    after = mesh.next[before]
    first, second = vectors[:, before], vectors[:, after]
    p, q = np.triu_indices(len(points), 1)
    left, right = first[p] * second[q], first[q] * second[p]
    parallel = (np.abs(left - right) <= PLANE_ROUNDING * (np.abs(left) + np.abs(right))).all(axis=0)
    bad = np.flatnonzero(parallel & (column_dot(first, second) < 0))
    if bad.size:
        vertex = int(mesh.tails[after[bad[0]]])
        back = "the curve doubles back at {vertex}, {place}; move or remove it"
        message = Message(back, vertex=_name(mesh, VERTEX, vertex), place=written(curve.vertices[vertex]))
        raise CurveError(message, at_vertices(curve, vertex))
    if curve.dimension > 3:
        for i, j, _ in near_edges(curve, points, lambda: nearest**2):
            for pair in sorted(np.sort(np.stack([i, j], axis=1), axis=1).tolist()):
                raise _refusal(TOUCHING, curve, *pair)
        return
    # Pairs that no plane separates certainly in floating-point numbers are decided exactly, and never all at once:
    # where thousands of edges coincide there are millions, and the first is enough.
    tree, count = BoxTree.build(mesh, points), 0
    for a, b in tree.pairs(nearer_than(lambda: 0.0)):
        pairs = np.sort(tree.order[np.stack([a, b])], axis=0)
        for k, other in sorted(pairs[:, doubtful(points, corners(mesh, *pairs))].T.tolist()):
            given = curve.vertices[corners(mesh, k, other)]  # scaling may cost the smallest digits
            if first_contact(given, given) is not None:
                raise _refusal(TOUCHING, curve, k, other)
            if count == 2000:  # that take about a second; `check_gap` refuses strands that need more, if not this
                raise _refusal(DOUBTFUL, curve, k, other)
            count += 1


def meeting_point(ends: FloatArray) -> FloatArray:
    """Return a point of the first edge near the second, for a message; ``ends`` has shape (4, m)."""
    x0, x1, y0, y1 = ends
    x = x0 + np.linspace(0.0, 1.0, 257)[:, None] * (x1 - x0)
    f = y1 - y0
    r = ((x - y0) @ f / max(f @ f, TINY)).clip(0.0, 1.0)
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
        what, where = TOO_NEAR, np.asarray(pair[:2].mean(axis=0))
        if (s := crossing(pair[0], pair[1], pair[2:])) is not None:
            what, where = (PIERCES if 0 < s < 1 else TOUCHES), pair[0] + s * (pair[1] - pair[0])
        else:
            for four in (pair[[0, 1, *side]] for side in reversed(EDGES)):
                if first_contact(four, four) is not None:
                    what, where = TOUCHES, meeting_point(four)
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
    tree = BoxTree.build(curve.mesh, own)
    for a, b in tree.pairs_with(still.tree, nearer_than(lambda: radius**2)):
        vertices = np.concatenate([tree.corners[:, a], len(curve) + still.tree.corners[:, b]])
        close = np.flatnonzero(doubtful(points, vertices, radius))
        for k in close[np.argsort(tree.order[a[close]], kind="stable")].tolist():
            yield int(tree.order[a[k]]), given[vertices[:, k]], still.obstacle_of(int(still.tree.order[b[k]]))


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
