"""How near a curve is to obstacles, which must not touch it, and whether it survives the rounding of new vertices."""

from collections.abc import Iterator, Sequence

import numpy as np

from ..curve import Curve
from ..curve.places import at_edges
from ..errors import CurveError
from ..messages import EDGE, Message
from ..obstacle import Obstacle
from ..types import BoolArray, FloatArray, IntArray
from .boxes import BoxTree, Level, still_triangles
from .embedded import meeting_point, numbered, written
from .exact import first_contact
from .exact_triangle import EDGES, crossing
from .gap import MIN_GAP, folds, minimal_gap, scaled_points, squared_gaps, squared_segment_distances
from .planes import Separation, closest_chord, relative_motion

# Bound of the rounding errors of tail + t (head − tail), in units of the last place of the largest coordinate: one each
# of the difference, which may be twice as large, and of the product, and half a one of the sum.  That of t itself only
# moves the vertex along its edge.
UNITS = 2.5

PIERCES = Message("{component}: {edge} pierces {obstacle} at {place}; move one of them away")
TOUCHES = Message("{component}: {edge} touches {obstacle} at {place}; move one of them away")
TOO_NEAR = Message("{component}: {edge} comes too near to {obstacle} at {place}; move one of them away")


def check_clear(curve: Curve, obstacles: Sequence[Obstacle]) -> None:
    """Refuse a curve that touches obstacles or comes too near to them to compute with; inside a closed one it may be.

    Raises
    ------
    CurveError
        If there are obstacles and the curve is not in space, or not clear of them: one sentence that names the
        component, its edge, counted from 1, the obstacle and the place.
    """
    if not obstacles:
        return
    if curve.dimension != 3:
        raise CurveError(
            f"the curve has dimension {curve.dimension}, but obstacles are in space; "
            "give its vertices three coordinates, or leave the obstacles out"
        )
    for edge, corners, obstacle in _near(curve, obstacles, MIN_GAP * curve.length):
        what, where = _meeting(corners)
        component, k = numbered(curve.mesh, edge)
        reason = Message(
            what, component=component, edge=Message(EDGE, number=k), obstacle=obstacle.title, place=written(where)
        )
        raise CurveError(reason, at_edges(curve, (edge,), where))


def clears(curve: Curve, obstacles: Sequence[Obstacle], distance: float) -> bool:
    """Whether a curve that is clear of obstacles certainly is further from them than a distance."""
    return not obstacles or next(_near(curve, obstacles, distance), None) is None


def _near(curve: Curve, obstacles: Sequence[Obstacle], distance: float) -> Iterator[tuple[int, FloatArray, Obstacle]]:
    """Edges and obstacles not certainly further apart than a distance, with the pairs' vertices, shape (5, 3).

    Certainly but for the rounding of distances, a few units of the last place: what counts on it leaves more.
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
        close = np.flatnonzero(_doubtful(points, vertices, radius))
        for k in close[np.argsort(tree.order[a[close]], kind="stable")].tolist():
            yield int(tree.order[a[k]]), given[vertices[:, k]], still.obstacle_of(int(still.tree.order[b[k]]))


def _doubtful(points: FloatArray, vertices: IntArray, radius: float) -> BoolArray:
    """Pairs at a distance of at most the radius, or without a plane that certainly separates them; shape (pairs,)."""
    motion = relative_motion(points, points, vertices)
    chord = closest_chord(motion[0])
    planes = Separation(motion, np.abs(motion).sum(axis=1), chord)
    near = np.einsum("mp,mp->p", chord, chord) <= radius**2
    return np.asarray(near | ~planes.proves(np.zeros(chord.shape[1])))


def _meeting(corners: FloatArray) -> tuple[str, FloatArray]:
    """What an edge does to a triangle near it, and where; ``corners`` has shape (5, 3)."""
    s = crossing(corners[0], corners[1], corners[2:])
    if s is not None:
        return (PIERCES if 0 < s < 1 else TOUCHES), corners[0] + s * (corners[1] - corners[0])
    touched = [four for four in (corners[[0, 1, *ends]] for ends in EDGES) if first_contact(four, four) is not None]
    if touched:
        return TOUCHES, meeting_point(touched[0])
    return TOO_NEAR, np.asarray(corners[:2].mean(axis=0))


def survives_rounding(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> bool:
    """Whether vertices that lie on edges but for rounding can move onto these without any contact.

    Then the curve with them and the curve without them are isotopic: no point moves by more than r, the rounding, and
    what must not meet, edges that are no neighbours and `folds`, is more than 2 r apart, and obstacles, which the curve
    does not touch, more than r from it (and a bit, for the rounding of that distance). In more than three dimensions
    there is nothing to keep.
    """
    if curve.dimension > 3:
        return True
    rounding = UNITS * np.spacing(np.abs(curve.vertices).max()) * np.sqrt(curve.dimension)
    nearest = min(minimal_gap(curve)[0], _fold_gap(curve))
    return bool(nearest > 2.1 * rounding) and clears(curve, obstacles, float(1.1 * rounding))


def _fold_gap(curve: Curve) -> float:
    """The smallest distance of a vertex from the segment that it must not lie on; infinite if there is none."""
    points, unit = scaled_points(curve)
    squares = squared_segment_distances(points, folds(curve.mesh))
    return float(np.ldexp(np.sqrt(np.min(squares, initial=np.inf)), unit))
