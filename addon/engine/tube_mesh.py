"""The surface of a tube around polygons in motion: rings of as many vertices at every key, in the same order."""

import numpy as np

from ...core.curve import Mesh
from ...core.types import FloatArray, IntArray
from .ribbon import edges_around, normals, tangents, unit

_LONGEST_MITRE = 2.0  # at corners sharper than 120° rings do not reach as far out as the edges' cylinders meet


def rings(points: FloatArray, radii: FloatArray, mesh: Mesh, sides: int) -> FloatArray:
    """Vertices of the tube, those of a ring one after the other; (keys, n · sides, 3).

    Rings lie in the planes that halve the angle between two edges, and are stretched where these meet at a corner so
    that the tube is as thick along the edges as it should be.

    Parameters
    ----------
    points
        Vertices of the polygons at every key, (keys, n, 3).
    radii
        Radius of the tube at each of them, (keys, n).
    mesh
        Their connectivity.
    sides
        Number of vertices of a ring.
    """
    each = zip(mesh.slices, mesh.closed, strict=True)
    pieces = [_rings(points[:, s], radii[:, s], sides, closed) for s, closed in each]
    return np.concatenate(pieces, axis=1).reshape(len(points), -1, 3)


def quads(mesh: Mesh, sides: int) -> IntArray:
    """Faces between rings, edge by edge, seen counterclockwise from outside; (edges · sides, 4)."""
    j = np.arange(sides)
    corners = [(mesh.tails, j), (mesh.tails, j + 1), (mesh.heads, j + 1), (mesh.heads, j)]
    return np.stack([ring[:, None] * sides + side % sides for ring, side in corners], axis=-1).reshape(-1, 4)


def caps(mesh: Mesh, sides: int) -> IntArray:
    """Faces that close the tubes of arcs, two for each, seen counterclockwise from outside; (2 · arcs, sides)."""
    j = np.arange(sides)
    both = np.stack([mesh.ends[:, :1] * sides + j[::-1], mesh.ends[:, 1:] * sides + j], axis=1)
    return np.asarray(both.reshape(-1, sides))


def _rings(points: FloatArray, radii: FloatArray, sides: int, closed: bool) -> FloatArray:
    """The rings of one component; (keys, n, sides, 3)."""
    tau, u = tangents(points, closed), normals(points, closed)
    v = np.cross(tau, u)
    theta = 2 * np.pi * np.arange(sides) / sides
    circle = np.cos(theta)[:, None] * u[..., None, :] + np.sin(theta)[:, None] * v[..., None, :]
    return points[:, :, None] + radii[..., None, None] * _mitred(circle, *edges_around(points, closed))


def _mitred(circle: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """Stretch rings by 1/cos(φ/2) in the plane of a corner where the curve turns by φ; (keys, n, sides, 3)."""
    cosine = 0.5 * np.linalg.norm(before + after, axis=-1)
    stretch = np.minimum(1.0 / np.maximum(cosine, 1.0 / _LONGEST_MITRE), _LONGEST_MITRE) - 1.0
    outward = unit(after - before)
    return np.asarray(circle + (circle @ outward[..., None]) * (stretch[..., None] * outward)[:, :, None, :])
