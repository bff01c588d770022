"""Obstacles that several tests need."""

import numpy as np
from mobius_flow.core import Obstacle


def box(low: float, high: float, name: str = "box") -> Obstacle:
    """A closed surface of twelve triangles: the cube of points between low and high in all coordinates."""
    corners = [[x, y, z] for x in (low, high) for y in (low, high) for z in (low, high)]
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return Obstacle(corners, [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))], name)


def plate(z: float, size: float = 100.0, name: str = "plate") -> Obstacle:
    """A square at a height, around the z-axis."""
    corners = [[-size, -size, z], [size, -size, z], [size, size, z], [-size, size, z]]
    return Obstacle(corners, [[0, 1, 2], [0, 2, 3]], name)


def rod(x: float, y: float, name: str = "rod") -> Obstacle:
    """A segment parallel to the z-axis."""
    return Obstacle([[x, y, -100.0], [x, y, 100.0]], [[0, 1]], name)


def sphere(radius: float, rings: int = 12, name: str = "sphere") -> Obstacle:
    """A closed surface around the origin, with needle triangles, and triangles without area, at the poles."""
    latitude, longitude = np.linspace(0.0, np.pi, rings + 1), 2 * np.pi * np.arange(2 * rings) / (2 * rings)
    p, q = np.meshgrid(latitude, longitude, indexing="ij")
    points = radius * np.stack([np.sin(p) * np.cos(q), np.sin(p) * np.sin(q), np.cos(p)], axis=-1).reshape(-1, 3)
    points[: 2 * rings], points[-2 * rings :] = points[0], points[-1]
    i, j = np.indices((rings, 2 * rings)).reshape(2, -1)
    a, b = 2 * rings * i + j, 2 * rings * i + (j + 1) % (2 * rings)
    faces = np.concatenate([[a, b, b + 2 * rings], [a, b + 2 * rings, a + 2 * rings]], axis=1)
    return Obstacle(points, faces.T, name)
