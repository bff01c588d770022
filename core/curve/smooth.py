"""Smooth curves through the vertices of a polygon."""

import numpy as np
from scipy.interpolate import CubicSpline

from ..types import FloatArray, IntArray
from .curve import Curve
from .mesh import Mesh
from .pins import NOWHERE

SAMPLES = 8  # points of a spline, for each vertex of its polygon, at which its arc length is measured


def smoothed(curve: Curve, mesh: Mesh, pins: IntArray = NOWHERE, places: IntArray = NOWHERE) -> Curve:
    """The polygon with vertices at equal distances along the cubic splines through the vertices of each component.

    ``mesh`` has its numbers of vertices.  Some vertices of the curve, ``pins``, ascending, become those at ``places``;
    distances are equal between consecutive ones.  A closed component without any keeps the place of its first vertex,
    arcs the places of their ends.
    """
    pieces = []
    for old, new, closed in zip(curve.mesh.slices, mesh.slices, mesh.closed, strict=True):
        own = (pins >= old.start) & (pins < old.stop)
        ends = [] if closed else [[0, 0], [old.stop - old.start - 1, new.stop - new.start - 1]]
        held = np.stack([pins[own] - old.start, places[own] - new.start], axis=1).tolist()
        anchors = np.unique([*ends, *held] or [[0, 0]], axis=0)
        pieces.append(_resampled(curve.vertices[old], closed, new.stop - new.start, *anchors.T))
    return Curve(np.concatenate(pieces), mesh)


def _resampled(points: FloatArray, closed: bool, size: int, pins: IntArray, places: IntArray) -> FloatArray:
    """Points on the spline, the given ones that are pins among them at their places; shape (size, m)."""
    spline = cubic_spline(points, closed)
    parameter = sample_parameters(spline)
    arc = arc_lengths(spline(parameter))
    at, numbers = arc[SAMPLES * pins], places[0] + np.arange(size)
    if closed:
        at, places = np.append(at, at[0] + arc[-1]), np.append(places, places[0] + size)
    wanted = np.empty(size)
    wanted[numbers % size] = np.interp(numbers, places, at)
    wanted[wanted > arc[-1]] -= arc[-1]
    return np.asarray(spline(np.interp(wanted, arc, parameter)))


def halved(curve: Curve) -> Curve:
    """Closed polygons with an additional vertex for each edge, on the splines through their vertices."""
    splines = [cubic_spline(points) for points in curve.components]
    places = [np.interp(np.arange(0.0, len(each.x) - 1.0, 0.5), np.arange(len(each.x)), each.x) for each in splines]
    return Curve.from_components([spline(at) for spline, at in zip(splines, places, strict=True)])


def cubic_spline(points: FloatArray, closed: bool = True) -> CubicSpline:
    """The cubic spline through the vertices of a polygon, shape (n, m), by its arc length; a natural one if open."""
    points = np.concatenate([points, points[:1]]) if closed else points
    return CubicSpline(arc_lengths(points), points, bc_type="periodic" if closed else "natural")


def sample_parameters(spline: CubicSpline) -> FloatArray:
    """Parameters from the first to the last, so many in each piece that chords between them are as good as arcs."""
    pieces = len(spline.x) - 1
    places = np.linspace(0.0, pieces, SAMPLES * pieces + 1)
    return np.asarray(np.interp(places, np.arange(pieces + 1), spline.x))


def arc_lengths(points: FloatArray) -> FloatArray:
    """Distances along a polyline from its first point; shape (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def at_shares(points: FloatArray, closed: bool, shares: FloatArray) -> FloatArray:
    """Points of a polygon at shares of its length; shape (k, m)."""
    points = np.concatenate([points, points[:1]]) if closed else points
    along = arc_lengths(points)
    return np.stack([np.interp(shares * along[-1], along, x) for x in points.T], axis=1)


def evenly(points: FloatArray, closed: bool, count: int) -> FloatArray:
    """A number of points of a polygon at equal distances along it, the first one included; shape (count, m)."""
    return at_shares(points, closed, np.linspace(0.0, 1.0, count, endpoint=not closed))
