"""Smooth curves through the vertices of a polygon."""

import numpy as np
from scipy.interpolate import CubicSpline

from ..types import FloatArray, IntArray
from .curve import Curve
from .mesh import Mesh
from .pins import NOWHERE

SAMPLES = 8  # points of a spline, for each vertex of its polygon, at which its arc length is measured


def smoothed(curve: Curve, mesh: Mesh, pins: IntArray = NOWHERE, places: IntArray = NOWHERE) -> Curve:
    """The polygon with vertices at equal distances along the periodic cubic splines through those of each component.

    Parameters
    ----------
    mesh
        Its numbers of vertices, for as many components as the curve has.
    pins, places
        Vertices of the curve, ascending, and which ones of the polygon they are; shape (k,).  Distances are equal from
        one of them to the next; a component without any has its first vertex at the same place.
    """
    pieces = []
    for old, new in zip(curve.mesh.slices, mesh.slices, strict=True):
        own = (pins >= old.start) & (pins < old.stop)
        anchors = (pins[own] - old.start, places[own] - new.start) if own.any() else (np.zeros(1, dtype=np.intp),) * 2
        pieces.append(_resampled(curve.vertices[old], new.stop - new.start, *anchors))
    return Curve(np.concatenate(pieces), mesh)


def _resampled(points: FloatArray, size: int, pins: IntArray, places: IntArray) -> FloatArray:
    """Points on the spline, the given ones that are pins among them at their places; shape (size, m)."""
    spline = periodic_spline(points)
    parameter = sample_parameters(spline)
    arc = arc_lengths(spline(parameter))
    wanted, at = np.empty(size), arc[SAMPLES * pins]
    for k, start in enumerate(places):
        following = (k + 1) % len(places)
        count = int(places[following] - start - 1) % size + 1
        length = at[following] - at[k] + (arc[-1] if at[following] <= at[k] else 0.0)
        wanted[(start + np.arange(count)) % size] = (at[k] + length * np.arange(count) / count) % arc[-1]
    return np.asarray(spline(np.interp(wanted, arc, parameter)))


def periodic_spline(points: FloatArray) -> CubicSpline:
    """The periodic cubic spline through the vertices of a closed polygon, shape (n, m), by its arc length."""
    closed = np.concatenate([points, points[:1]])
    return CubicSpline(arc_lengths(closed), closed, bc_type="periodic")


def sample_parameters(spline: CubicSpline) -> FloatArray:
    """Parameters from the first to the last, so many to each piece that chords between them are as good as arcs."""
    pieces = len(spline.x) - 1
    places = np.linspace(0.0, pieces, SAMPLES * pieces + 1)
    return np.asarray(np.interp(places, np.arange(pieces + 1), spline.x))


def arc_lengths(points: FloatArray) -> FloatArray:
    """Distances along a polyline from its first point; shape (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
