"""Smooth curves through the vertices of a polygon."""

import numpy as np
from scipy.interpolate import CubicSpline

from ..types import FloatArray
from .curve import Curve
from .mesh import Mesh

SAMPLES = 8  # points of a spline, for each vertex of its polygon, at which its arc length is measured


def smoothed(curve: Curve, mesh: Mesh) -> Curve:
    """The polygon with vertices at equal distances along the periodic cubic splines through those of each component.

    Parameters
    ----------
    mesh
        Its numbers of vertices, for as many components as the curve has.
    """
    pairs = zip(curve.components, mesh.component_sizes, strict=True)
    return Curve(np.concatenate([_resampled(component, size) for component, size in pairs]), mesh)


def _resampled(points: FloatArray, size: int) -> FloatArray:
    """Points on the spline, the first of them the first one given; shape (size, m)."""
    closed = np.concatenate([points, points[:1]])
    spline = CubicSpline(_arc(closed), closed, bc_type="periodic")
    parameter = np.interp(np.linspace(0.0, len(points), SAMPLES * len(points) + 1), np.arange(len(closed)), spline.x)
    arc = _arc(spline(parameter))
    return np.asarray(spline(np.interp(arc[-1] * np.arange(size) / size, arc, parameter)))


def _arc(points: FloatArray) -> FloatArray:
    """Distances along a polyline from its first point; shape (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
