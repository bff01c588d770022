"""Messy polygons of the same knot type, by random vertex moves that are each checked to be an isotopy."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from ..curve import Curve, check_closed
from ..errors import CurveError
from ..types import FloatArray, IntArray
from .sweeps import angle_to_sector, triangle_distances

_MIN_ANGLE = 0.2  # radians between neighbouring edges, so that edges never fold onto each other
_MIN_GAP = 1e-6  # of the radius; rounding in the distances, at most 1e-8 of it, must stay far below the gap


@checked
def scramble(
    curve: Curve,
    seed: int,
    *,
    moves: int | None = None,
    reach: float | None = None,
    gap: float | None = None,
) -> Curve:
    """Make a messy polygon of the same knot type with the same numbers of vertices.

    Vertices move one at a time, straight and far, wherever the swept triangles are free of other edges; the
    curve stays within the ball that held it.

    Parameters
    ----------
    curve
        Polygons in space that don't touch.
    seed
        The same seed gives the same curve.
    moves
        Number of moves tried, by default 20 for every vertex.
    reach
        Length of the longest move, in the curve's units; by default half the curve's radius.
    gap
        Distance that moving edges keep from others, at least a millionth of the curve's radius; by default a
        twentieth of the mean edge length.

    Raises
    ------
    CurveError
        If the curve is not in space or a number is not allowed.
    """
    points = curve.vertices.copy()
    for vertex, position in certified_moves(curve, seed, moves=moves, reach=reach, gap=gap):
        points[vertex] = position
    return curve.with_vertices(points)


def certified_moves(
    curve: Curve, seed: int, *, moves: int | None = None, reach: float | None = None, gap: float | None = None
) -> Iterator[tuple[int, FloatArray]]:
    """Give one after the other the vertices that :func:`scramble` moves, and where each moves to."""
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
    if not _MIN_GAP * radius <= gap < math.inf:
        raise CurveError(f"gap is {gap}; it must be at least {_MIN_GAP:g} of the curve's radius, {radius:g}")
    return _moves(_Polygons.of(curve), np.random.default_rng(seed), moves, reach, gap, (center, radius))


def _moves(
    polygons: "_Polygons",
    rng: np.random.Generator,
    moves: int,
    reach: float,
    gap: float,
    ball: tuple[FloatArray, float],
) -> Iterator[tuple[int, FloatArray]]:
    center, radius = ball
    for _ in range(moves):
        vertex = int(rng.integers(len(polygons.points)))
        step = rng.normal(size=3)
        # Lengths spread over a decade: long moves get stuck first, short ones go on finding room.
        step *= reach * 10.0 ** -rng.random() / np.linalg.norm(step)
        position = polygons.points[vertex] + step
        if np.linalg.norm(position - center) <= radius and polygons.can_move(vertex, position, gap):
            polygons.points[vertex] = position
            yield vertex, position


@dataclass
class _Polygons:
    """Polygons under way: positions that change, and who is whose neighbour."""

    points: FloatArray
    before: IntArray
    after: IntArray

    @classmethod
    def of(cls, curve: Curve) -> "_Polygons":
        before = np.empty_like(curve.mesh.heads)
        before[curve.mesh.heads] = curve.mesh.tails
        return cls(curve.vertices.copy(), before, curve.mesh.heads)

    def can_move(self, vertex: int, position: FloatArray, gap: float) -> bool:
        """Whether the straight move of a vertex keeps its edges ``gap`` away from the others all the way."""
        old, a, b = self.points[vertex], int(self.before[vertex]), int(self.after[vertex])
        return all(
            self._opens(pivot, old, position, beyond) and self._free(vertex, pivot, old, position, gap)
            for pivot, beyond in ((a, int(self.before[a])), (b, int(self.after[b])))
        )

    def _opens(self, pivot: int, old: FloatArray, new: FloatArray, beyond: int) -> bool:
        """Whether the edge that turns about ``pivot`` stays away from the next edge there."""
        here = self.points[pivot]
        return angle_to_sector(self.points[beyond] - here, old - here, new - here) >= _MIN_ANGLE

    def _free(self, vertex: int, pivot: int, old: FloatArray, new: FloatArray, gap: float) -> bool:
        """Whether the triangle swept by the edge from ``pivot`` to the vertex is free of edges beyond both."""
        triangle = np.stack([self.points[pivot], old, new])
        tails, heads = self.points, self.points[self.after]
        low, high = triangle.min(axis=0) - gap, triangle.max(axis=0) + gap
        near = ((np.minimum(tails, heads) <= high) & (np.maximum(tails, heads) >= low)).all(axis=1)
        own = [vertex, self.before[vertex], pivot, self.before[pivot]]
        near[own] = False
        return not near.any() or bool(triangle_distances(triangle, tails[near], heads[near]).min() >= gap)
