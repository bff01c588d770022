"""Smooth curves through the vertices of a polygon."""

import numpy as np
from scipy.interpolate import CubicSpline

from ..types import FloatArray
from .curve import Curve
from .mesh import Mesh

SAMPLES = 8  # points of a spline, for each vertex of its polygon, at which its arc length is measured


def smoothed(curve: Curve, mesh: Mesh) -> Curve:
    """The polygon with vertices at equal distances along the cubic splines through those of each component.

    Parameters
    ----------
    mesh
        Its numbers of vertices, for as many components as the curve has.
    """
    each = zip(curve.components, curve.mesh.closed, mesh.component_sizes, mesh.edge_counts, strict=True)
    return Curve(np.concatenate([_resampled(*component) for component in each]), mesh)


def _resampled(points: FloatArray, closed: bool, size: int, edges: int) -> FloatArray:
    """Points on the spline, the first of them the first one given, and the last the last of an arc; shape (size, m)."""
    spline = periodic_spline(points) if closed else open_spline(points)
    parameter = sample_parameters(spline)
    arc = arc_lengths(spline(parameter))
    return np.asarray(spline(np.interp(arc[-1] * np.arange(size) / edges, arc, parameter)))


def periodic_spline(points: FloatArray) -> CubicSpline:
    """The periodic cubic spline through the vertices of a closed polygon, shape (n, m), by its arc length."""
    closed = np.concatenate([points, points[:1]])
    return CubicSpline(arc_lengths(closed), closed, bc_type="periodic")


def open_spline(points: FloatArray) -> CubicSpline:
    """The natural cubic spline through the vertices of an arc, shape (n, m), by its arc length."""
    return CubicSpline(arc_lengths(points), points, bc_type="natural")


def sample_parameters(spline: CubicSpline) -> FloatArray:
    """Parameters from the first to the last, so many to each piece that chords between them are as good as arcs."""
    pieces = len(spline.x) - 1
    places = np.linspace(0.0, pieces, SAMPLES * pieces + 1)
    return np.asarray(np.interp(places, np.arange(pieces + 1), spline.x))


def arc_lengths(points: FloatArray) -> FloatArray:
    """Distances along a polyline from its first point; shape (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
