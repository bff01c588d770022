"""Whether a vertex can move straight without an edge passing through another.

Moving vertex v to v' sweeps the triangles (a, v, v') and (v, v', b), where a and b are its neighbours. If
no other edge comes near them, the polygons before and after are isotopic: this is the elementary move of
combinatorial knot theory (Reidemeister, *Knotentheorie*, 1932).
"""

import numpy as np

from ..types import BoolArray, FloatArray

_TINY = 1e-300


def segment_distances(p: FloatArray, q: FloatArray, tails: FloatArray, heads: FloatArray) -> FloatArray:
    """Distances of the segment from ``p`` to ``q``, shape (3,), to the segments (k, 3); shape (k,).

    Source: Ericson, *Real-Time Collision Detection* (2005), section 5.1.9.
    """
    d, e = q - p, heads - tails
    r = p - tails
    dd, ee, de = d @ d, (e * e).sum(axis=1), e @ d
    dr, er = r @ d, (e * r).sum(axis=1)
    s = np.clip((de * er - dr * ee) / np.maximum(dd * ee - de * de, _TINY), 0.0, 1.0)
    t = (de * s + er) / np.maximum(ee, _TINY)
    # Where t leaves its range, or is arbitrary since the segment is a point, s is solved anew for the clipped t.
    again = (t < 0) | (t > 1) | (ee <= _TINY)
    s = np.where(again, np.clip((np.clip(t, 0.0, 1.0) * de - dr) / max(dd, _TINY), 0.0, 1.0), s)
    t = np.clip(t, 0.0, 1.0)
    between = r + s[:, None] * d - t[:, None] * e
    return np.asarray(np.sqrt((between * between).sum(axis=1)))


def triangle_distances(triangle: FloatArray, tails: FloatArray, heads: FloatArray) -> FloatArray:
    """Distances of a triangle (3, 3) to segments (k, 3); shape (k,), 0 where a segment pierces it."""
    a, b, c = triangle
    sides = [segment_distances(p, q, tails, heads) for p, q in ((a, b), (b, c), (c, a))]
    normal = np.cross(b - a, c - a)
    size = np.sqrt(normal @ normal)
    if size <= _TINY:
        return np.asarray(np.minimum.reduce(sides))
    below, above = (tails - a) @ normal / size, (heads - a) @ normal / size
    ends = [
        np.where(_over(triangle, normal, x), np.abs(height), np.inf) for x, height in ((tails, below), (heads, above))
    ]
    crossing = below * above < 0
    share = np.where(crossing, below / np.where(crossing, below - above, 1.0), 0.0)
    pierced = crossing & _over(triangle, normal, tails + share[:, None] * (heads - tails))
    return np.where(pierced, 0.0, np.minimum.reduce([*sides, *ends]))


def _over(triangle: FloatArray, normal: FloatArray, points: FloatArray) -> BoolArray:
    """Which points (k, 3) lie over the triangle, seen along its normal."""
    inside = np.ones(len(points), dtype=bool)
    for p, q in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
        inside &= (points - p) @ np.cross(normal, q - p) >= 0
    return inside


def angle_to_sector(direction: FloatArray, first: FloatArray, second: FloatArray) -> float:
    """Least angle between a direction (3,) and those from ``first`` to ``second``, the short way; radians."""
    least = min(_angle(direction, first), _angle(direction, second))
    normal = np.cross(first, second)
    size = np.sqrt(normal @ normal)
    if size <= _TINY:
        return least
    after, before = np.cross(normal, first) @ direction, np.cross(second, normal) @ direction
    if after < 0 or before < 0:
        return least
    height = abs(direction @ normal) / (size * np.sqrt(direction @ direction))
    return float(np.arcsin(min(height, 1.0)))


def _angle(u: FloatArray, v: FloatArray) -> float:
    w = np.cross(u, v)
    return float(np.arctan2(np.sqrt(w @ w), u @ v))
