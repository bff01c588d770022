"""Uniform cubic B-splines in space: periodic ones, and clamped ones, which run from their first point to their last.

The parameter runs from 0 to 1, through segments of equal length.
"""

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import BSpline

from ...core.types import FloatArray, IntArray

FEWEST = 4  # control points of a cubic spline
_DEGREE = 3
_TO_BEZIER = np.array([[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]]) / 6.0


def bezier_points(points: FloatArray, closed: bool = True) -> FloatArray:
    """Bézier points of the segments of a spline with these control points, from end to end; (k, 3) to (segments, 4, 3).

    A periodic spline has as many segments as control points, a clamped one three less.
    """
    if closed:
        return np.asarray(_TO_BEZIER @ np.stack([np.roll(points, -k, axis=0) for k in range(-1, 3)], axis=1))
    knots = _clamped_knots(len(points))
    joints = knots[_DEGREE:-_DEGREE]
    spline = BSpline(knots, points, _DEGREE)
    place, handle = spline(joints), spline(joints, 1) / _DEGREE
    corners = (place[:-1], place[:-1] + handle[:-1], place[1:] - handle[1:], place[1:])
    return np.stack(corners, axis=1)


def basis(t: FloatArray, count: int, closed: bool) -> sp.csr_array:
    """Values of the B-splines of so many control points at parameters; (parameters, count)."""
    if not closed:
        return BSpline.design_matrix(t * (count - _DEGREE), _clamped_knots(count), _DEGREE)
    segment, u = _segments(t, count)
    values = _bernstein(u) @ _TO_BEZIER
    rows = np.repeat(np.arange(len(t)), _DEGREE + 1)
    columns = (segment[:, None] + np.arange(-1, 3)) % count
    return sp.csr_array((values.ravel(), (rows, columns.ravel())), shape=(len(t), count))


def evaluated(bezier: FloatArray, t: FloatArray) -> FloatArray:
    """Points of a spline, given by its Bézier points, at parameters; (parameters, 3)."""
    segment, u = _segments(t, len(bezier))
    return np.asarray(np.einsum("ni,nij->nj", _bernstein(u), bezier[segment]))


def _clamped_knots(count: int) -> FloatArray:
    """Knots 0, 0, 0, 0, 1, 2, … with the last one four times too, as Blender has them at *Endpoint*."""
    inner = np.arange(count - _DEGREE + 1, dtype=np.float64)
    return np.pad(inner, _DEGREE, mode="edge")


def _segments(t: FloatArray, count: int) -> tuple[IntArray, FloatArray]:
    """Number of the segment that a parameter lies in, and how far along it."""
    segment = np.minimum((t * count).astype(np.intp), count - 1)
    return segment, t * count - segment


def _bernstein(u: FloatArray) -> FloatArray:
    v = 1.0 - u
    return np.stack([v**3, 3 * u * v**2, 3 * u**2 * v, u**3], axis=-1)
