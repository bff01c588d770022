"""Tubes of constant radius around polygons: rings of points, and the triangles between them."""

from typing import NamedTuple

import numpy as np

from .curve import Curve
from .types import FloatArray, IntArray

SIDES = 12
_SHARPEST = 4.0  # radii by which mitres reach along their edges, at most


class Tube(NamedTuple):
    """A surface: corners and unit normals there, each (k, 3), and triangles that are seen from outside, (f, 3)."""

    points: FloatArray
    normals: FloatArray
    faces: IntArray


def tubes(curve: Curve, radius: float, sides: int = SIDES) -> list[Tube]:
    """The tubes around the components of a curve in the plane or in space, with flat ends where they are open.

    Rings lie in the planes that bisect the angles at vertices, so that every edge is the axis of a cylinder.  From edge
    to edge the frame is reflected in these planes, which turns it least; round a closed component what is left of
    turning is spread evenly.
    """
    parts = (np.pad(part, ((0, 0), (0, 3 - curve.dimension))) for part in curve.components)
    return [_tube(part, closed, radius, sides) for part, closed in zip(parts, curve.mesh.closed, strict=True)]


def _tube(points: FloatArray, closed: bool, radius: float, sides: int) -> Tube:
    edges = np.roll(points, -1, axis=0) - points
    if not closed:
        edges[-1] = edges[-2]
    edges /= np.linalg.norm(edges, axis=1, keepdims=True)
    bisectors = edges + np.roll(edges, 1, axis=0)
    if not closed:
        bisectors[0] = edges[0]
    cosines = np.maximum(np.einsum("nm,nm->n", edges, bisectors), 1e-9)  # at a fold there is no such plane
    first = np.cross(edges[0], np.eye(3)[np.abs(edges[0]).argmin()])
    axes = [first / np.linalg.norm(first)]
    for k in range(1, len(points) + closed):
        axes.append(_reflected(axes[-1], edges[k - 1], edges[k % len(points)]))
    u = np.array(axes[: len(points)])
    v = np.cross(edges, u)
    turn = np.arctan2(axes[-1] @ v[0], axes[-1] @ u[0]) if closed else 0.0
    angles = 2 * np.pi * np.arange(sides) / sides - turn * np.arange(len(points))[:, None] / len(points)
    normals = np.cos(angles)[:, :, None] * u[:, None] + np.sin(angles)[:, :, None] * v[:, None]
    along = np.einsum("nsm,nm->ns", normals, bisectors) / cosines[:, None]
    along = np.clip(along, -_SHARPEST, _SHARPEST)
    rings = points[:, None] + radius * (normals - along[:, :, None] * edges[:, None])
    return Tube(rings.reshape(-1, 3), normals.reshape(-1, 3), _faces(len(points), sides, closed))


def _reflected(axis: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """The image of a vector across an edge in the plane that bisects its angle with the next edge; of length 1."""
    axis = axis - (axis @ after) / max(1.0 + float(before @ after), 1e-9) * (before + after)
    axis = axis - (axis @ after) * after
    return np.asarray(axis / np.linalg.norm(axis))


def _faces(rings: int, sides: int, closed: bool) -> IntArray:
    ring, side = np.meshgrid(np.arange(rings if closed else rings - 1), np.arange(sides), indexing="ij")
    a, b = sides * ring + side, sides * ring + (side + 1) % sides
    c, d = (a + sides) % (rings * sides), (b + sides) % (rings * sides)
    faces = np.stack([a, b, c, b, d, c], axis=-1).reshape(-1, 3)
    if closed:
        return np.asarray(faces)
    fan = np.stack([np.zeros(sides - 2, dtype=np.intp), np.arange(1, sides - 1), np.arange(2, sides)], axis=1)
    return np.asarray(np.concatenate([faces, fan[:, [0, 2, 1]], fan + (rings - 1) * sides]))
