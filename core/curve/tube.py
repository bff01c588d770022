"""Tubes around polygons in motion: rings of as many points at every key, in the same order, and faces between them.

Rings neither jump nor twist more than they must. Their normals are carried along the curve by parallel transport;
carried once round a closed curve they come back turned by the holonomy, and the angle that is missing is spread evenly
over the length. In a motion that angle may grow beyond half a turn: the self-linking number of the framed curve is a
whole number, so it cannot change without a jump, and whatever writhe the curve loses its framing gains as twist
(Călugăreanu, White, Fuller). The last key has the least. Along an arc nothing has to close, and normals do not twist.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base import TINY, FloatArray, IntArray, dot
from .curve import Curve
from .mesh import Mesh
from .refine import interpolated


class Tube(NamedTuple):
    """A surface: corners and unit normals there, each (k, 3), and triangles that are seen from outside, (f, 3)."""

    points: FloatArray
    normals: FloatArray
    faces: IntArray


def tubes(curves: Sequence[Curve], radius: float, sides: int = 12) -> list[list[Tube]]:
    """Tubes around curves on one mesh that follow each other, in the plane or in space: by component, then by curve.

    Their rings are those of `rings`; the ends of arcs are closed, and flat.
    """
    mesh = curves[0].mesh
    points = np.array([np.pad(each.vertices, ((0, 0), (0, 3 - each.dimension))) for each in curves])
    made = []
    for part, size, closed in zip(mesh.slices, mesh.component_sizes, mesh.closed, strict=True):
        # the faces of `quads` and `caps` as triangles, fans with the first corner of each
        piece = Mesh((size,), (closed,))
        fans = [
            np.stack([np.broadcast_to(faces[:, :1], faces[:, 2:].shape), faces[:, 1:-1], faces[:, 2:]], axis=-1)
            for faces in (quads(piece, sides), caps(piece, sides))
        ]
        faces = np.concatenate([fan.reshape(-1, 3) for fan in fans])
        normal, ring = _rings(points[:, part], np.full((1, size), radius), closed, sides)
        made.append([Tube(p.reshape(-1, 3), n.reshape(-1, 3), faces) for p, n in zip(ring, normal, strict=True)])
    return made


def rings(points: FloatArray, radii: FloatArray, mesh: Mesh, sides: int) -> FloatArray:
    """Vertices of the tube, those of a ring one after the other; (keys, n · sides, 3).

    Rings lie in the planes that halve the angle between two edges, and are stretched where these meet at a corner so
    that the tube is as thick along the edges as it should be. Points: (keys, n, 3); radii: (keys, n).
    """
    pieces = [
        _rings(points[:, part], radii[:, part], closed, sides)[1]
        for part, closed in zip(mesh.slices, mesh.closed, strict=True)
    ]
    return np.concatenate(pieces, axis=1).reshape(len(points), -1, 3)


def _rings(points: FloatArray, radii: FloatArray, closed: bool, sides: int) -> tuple[FloatArray, FloatArray]:
    """Unit normals round one component, and its rings; (keys, n, sides, 3) each, from (keys, n, 3) and (keys, n)."""
    tau, u = tangents(points, closed), normals(points, closed)
    theta = 2 * np.pi * np.arange(sides) / sides
    circle = turned(u[..., None, :], tau[..., None, :], theta)
    # stretched by 1/cos(φ/2) in the plane of a corner where the curve turns by φ; at corners sharper than 120° rings do
    # not reach as far out as the edges' cylinders meet
    before, after = edges_around(points, closed)
    cosine, outward = 0.5 * np.linalg.norm(before + after, axis=-1), unit(after - before)
    stretch = np.minimum(1.0 / np.maximum(cosine, 0.5), 2.0) - 1.0
    mitred = circle + (circle @ outward[..., None]) * (stretch[..., None] * outward)[:, :, None, :]
    return circle, points[:, :, None] + radii[:, :, None, None] * mitred


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


def tangents(points: FloatArray, closed: bool = True) -> FloatArray:
    """Unit tangents at the vertices of polygons, halfway between those of their edges; (..., n, 3) to same."""
    before, after = edges_around(points, closed)
    return unit(before + after)


def edges_around(points: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray]:
    """Unit vectors along the edges before and after each vertex; at an end of an arc twice that of its only edge."""
    if closed:
        after = unit(np.roll(points, -1, axis=-2) - points)
        return np.roll(after, 1, axis=-2), after
    along = unit(np.diff(points, axis=-2))
    return np.concatenate([along[..., :1, :], along], axis=-2), np.concatenate([along, along[..., -1:, :]], axis=-2)


def normals(points: FloatArray, closed: bool = True) -> FloatArray:
    """Unit normals at vertices of one polygon in motion, turned as little as possible from key to key; (keys, n, 3)."""
    tau = tangents(points, closed)
    # carried along from the first vertex, each by the least rotation from tangent to tangent
    bare = np.empty_like(tau)
    axis = np.eye(3)[np.abs(tau[:, 0]).argmin(axis=-1)]  # never along the tangent
    bare[:, 0] = unit(axis - dot(axis, tau[:, 0])[..., None] * tau[:, 0])
    for i in range(1, tau.shape[1]):
        bare[:, i] = carried(bare[:, i - 1], tau[:, i - 1], tau[:, i])
    share = np.zeros(points.shape[:2])  # of what is missing at the end, by the length before each vertex
    if closed:
        lengths = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=-1)
        passed = np.cumsum(lengths, axis=1)
        share = (passed - lengths) / passed[:, -1:]
    holonomy = signed_angle(bare[:, 0], carried(bare[:, -1], tau[:, -1], tau[:, 0]), tau[:, 0])
    angles = -holonomy[:, None] * share
    normal = np.empty_like(bare)
    normal[-1] = turned(bare[-1], tau[-1], angles[-1])
    turns = 0.0
    for k in range(len(points) - 2, -1, -1):
        wanted = carried(normal[k + 1], tau[k + 1], tau[k])
        missing = signed_angle(turned(bare[k], tau[k], angles[k]), wanted, tau[k])
        # whole turns over the length, one more or less than at the next key, and an angle for all normals, that leave
        # least of the missing angles
        candidates = turns + np.array([-1.0, 0.0, 1.0])
        means = np.exp(1j * (missing - 2 * np.pi * candidates[:, None] * share[k])).mean(axis=1)
        best = int(np.abs(means).argmax())
        turns, offset = float(candidates[best]), float(np.angle(means[best]))
        normal[k] = turned(bare[k], tau[k], angles[k] + 2 * np.pi * turns * share[k] + offset)
    return normal


def places_between(points: FloatArray, mesh: Mesh) -> FloatArray:
    """Places among keys, 2.5 halfway between the third and the fourth, between which tangents turn by 30° at most.

    Straight lines between two rings make the tube thinner, by 3 % halfway. No gap is halved more than five times: what
    turns through itself is never smooth. Points: (keys, n, 3).
    """
    places = np.arange(len(points), dtype=np.float64)
    for _ in range(5):
        shapes, pieces = interpolated(points, places), zip(mesh.slices, mesh.closed, strict=True)
        tau = np.concatenate([tangents(shapes[:, s], closed) for s, closed in pieces], axis=1)
        far = dot(tau[:-1], tau[1:]).min(axis=1) < np.cos(np.radians(30.0))
        if not far.any():
            break
        places = np.sort(np.concatenate([places, 0.5 * (places[:-1] + places[1:])[far]]))
    return places


def carried(normal: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Turn normals by the least rotation that takes unit tangents ``start`` to ``end``; all of shape (..., 3)."""
    along = dot(normal, end) / np.maximum(1.0 + dot(start, end), TINY)
    moved = normal - along[..., None] * (start + end)
    return unit(moved - dot(moved, end)[..., None] * end)


def turned(normal: FloatArray, tau: FloatArray, angle: FloatArray) -> FloatArray:
    """Turn normals about unit tangents by angles; shapes (..., 3), (..., 3), (...)."""
    return np.asarray(np.cos(angle)[..., None] * normal + np.sin(angle)[..., None] * np.cross(tau, normal))


def signed_angle(start: FloatArray, end: FloatArray, tau: FloatArray) -> FloatArray:
    """Angles about unit tangents from one normal to the other, in [−π, π]; (..., 3) to (...)."""
    return np.asarray(np.arctan2(dot(np.cross(tau, start), end), dot(start, end)))


def unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), TINY))
