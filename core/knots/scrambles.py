"""Messy polygons of the same knot type, by random vertex moves that are each checked to be an isotopy.

Moving vertex v to v' sweeps the triangles (a, v, v') and (v, v', b), where a and b are its neighbours. If no other edge
comes near them, the polygons before and after are isotopic: this is the elementary move of combinatorial knot theory
(Reidemeister, *Knotentheorie*, 1932).
"""

import math

import numpy as np

from ..base import CurveError, FloatArray, checked
from ..collision.planes import closest_chord
from ..curve import Curve, check_closed


@checked
def scramble(
    curve: Curve,
    seed: int,
    *,
    moves: int | None = None,
    reach: float | None = None,
    gap: float | None = None,
    least_angle: float = 0.2,
) -> Curve:
    """Make a messy polygon of the same knot type with the same numbers of vertices.

    The vertices of closed polygons in space that don't touch move one at a time, straight and far, wherever the swept
    triangles are free of other edges; the curve stays within the ball that held it.  The same ``seed`` gives the same
    curve.  By default 20 ``moves`` are tried for every vertex, of at most half the ball's radius (``reach``), and keep
    edges a twentieth of their mean length from others (``gap``, at least a millionth of the radius) and
    ``least_angle``, in radians, from folding onto their neighbours.

    Raises CurveError if the curve is not in space or a number is not allowed.
    """
    if curve.dimension != 3:
        raise CurveError(f"the curve has dimension {curve.dimension}; only curves in space can be scrambled")
    check_closed(curve, "scrambles")
    center = curve.vertices.mean(axis=0)
    radius = float(np.linalg.norm(curve.vertices - center, axis=1).max())
    moves = 20 * len(curve) if moves is None else moves
    reach = radius / 2 if reach is None else reach
    gap = float(curve.edge_lengths.mean()) / 20 if gap is None else gap
    if seed < 0:
        raise CurveError(f"seed is {seed}; it must be 0 or more")
    if moves < 0 or not 0 < reach < math.inf:
        raise CurveError(f"moves is {moves} and reach {reach}; moves must be 0 or more and reach above 0")
    least = 1e-6  # of the radius: rounding in the distances, at most 1e-8 of it, must stay far below the gap
    if not least * radius <= gap < math.inf:
        raise CurveError(f"gap is {gap}; it must be at least {least:g} of the curve's radius, {radius:g}")
    if not 0 < least_angle < math.pi:
        raise CurveError(f"least_angle is {least_angle}; it must be above 0 and below π")
    points, before, after = curve.vertices.copy(), curve.mesh.anticycle, curve.mesh.heads

    def can_move(vertex: int, position: FloatArray) -> bool:
        """Whether the straight move of a vertex keeps its edges away from all others, and the next angles open."""
        old, a, b = points[vertex], before[vertex], after[vertex]
        tails, heads = points, points[after]
        for pivot, beyond in ((a, before[a]), (b, after[b])):
            here = points[pivot]
            if angle_to_sector(points[beyond] - here, old - here, position - here) < least_angle:
                return False
            triangle = np.stack([here, old, position])  # swept by the edge from the pivot to the vertex
            low, high = triangle.min(axis=0) - gap, triangle.max(axis=0) + gap
            near = ((np.minimum(tails, heads) <= high) & (np.maximum(tails, heads) >= low)).all(axis=1)
            near[[vertex, a, pivot, before[pivot]]] = False
            if near.any() and triangle_distances(triangle, tails[near], heads[near]).min() < gap:
                return False
        return True

    rng = np.random.default_rng(seed)
    for _ in range(moves):
        vertex = int(rng.integers(len(curve)))
        step = rng.normal(size=3)
        # Lengths spread over a decade: long moves get stuck first, short ones go on finding room.
        step *= reach * 10.0 ** -rng.random() / np.linalg.norm(step)
        position = points[vertex] + step
        if np.linalg.norm(position - center) <= radius and can_move(vertex, position):
            points[vertex] = position
    return curve.with_vertices(points)


def triangle_distances(triangle: FloatArray, tails: FloatArray, heads: FloatArray) -> FloatArray:
    """Distances of a triangle (3, 3) to segments (k, 3); shape (k,), 0 where a segment pierces it."""
    a, b, c = triangle
    edge = heads - tails
    motion = np.stack(np.broadcast_arrays(tails - a, edge, b - a, c - a)).swapaxes(1, 2)
    height = [(x - a) @ np.cross(b - a, c - a) for x in (tails, heads)]
    turns = np.array([(np.cross(p - tails, q - tails) * edge).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))])
    pierced = (height[0] * height[1] < 0) & ((turns >= 0).all(axis=0) | (turns <= 0).all(axis=0))
    return np.where(pierced, 0.0, np.linalg.norm(closest_chord(motion), axis=0))


def angle_to_sector(direction: FloatArray, first: FloatArray, second: FloatArray) -> float:
    """Least angle between a direction (3,) and any between ``first`` and ``second``, the short way; radians."""
    crosses = [(np.cross(direction, each), direction @ each) for each in (first, second)]
    least = min(float(np.arctan2(np.sqrt(w @ w), product)) for w, product in crosses)
    normal = np.cross(first, second)
    size = np.sqrt(normal @ normal)
    if size <= 1e-300:
        return least
    after, before = np.cross(normal, first) @ direction, np.cross(second, normal) @ direction
    if after < 0 or before < 0:
        return least
    height = abs(direction @ normal) / (size * np.sqrt(direction @ direction))
    return float(np.arcsin(min(height, 1.0)))
