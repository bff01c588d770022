"""Obstacles as collision detection sees them: triangles that stand still, in one tree that is built once."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..curve.ordering import z_order
from ..obstacle import Obstacle
from ..types import FloatArray, IntArray
from .boxes import BoxTree


@dataclass(frozen=True, eq=False)
class StillTriangles:
    """The simplices of several obstacles; a segment is a triangle two of whose vertices are one.

    Attributes
    ----------
    obstacles
        Whose they are.
    vertices
        Of all obstacles, in the user's units; shape (k, 3).
    tree
        Over the triangles in units of two to the power of ``exponent``.
    """

    obstacles: tuple[Obstacle, ...]
    vertices: FloatArray
    tree: BoxTree

    def obstacle_of(self, triangle: int) -> Obstacle:
        """The obstacle that a triangle, counted over all obstacles, belongs to."""
        ends = np.cumsum([len(each.faces) for each in self.obstacles])
        return self.obstacles[int(np.searchsorted(ends, triangle, side="right"))]


@lru_cache(maxsize=8)
def still_triangles(obstacles: tuple[Obstacle, ...], exponent: int) -> StillTriangles:
    """The triangles of some obstacles, coordinates of which are at most two to the power of ``exponent``."""
    vertices = np.concatenate([each.vertices for each in obstacles])
    first = np.cumsum([0, *(len(each.vertices) for each in obstacles)])
    triangles = np.concatenate([_triangles(each) + k for each, k in zip(obstacles, first[:-1], strict=True)])
    points = np.ldexp(vertices.T, -exponent, order="C")
    corners = triangles.T
    order = z_order(points[:, corners].mean(axis=1))
    return StillTriangles(obstacles, vertices, BoxTree.over(order, corners[:, order], points[None]))


def _triangles(obstacle: Obstacle) -> IntArray:
    return obstacle.faces[:, [0, 1, -1]]
