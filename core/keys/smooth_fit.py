"""Smooth curves that follow polygons: cubic splines, as NURBS and Bézier curves, and how far off they are.

Splines are uniform: periodic, or clamped from their first control point to their last, as Blender has them at
*Endpoint*. Their parameter runs from 0 to 1 through segments of equal length.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import BSpline
from scipy.sparse.linalg import splu

from ..base import FloatArray, IntArray
from ..collision import is_free
from ..curve import Curve, Mesh, vertex_positions
from ..curve.distances import points_along
from .tube import free_radius, strand_gap, thickest_radius

FEWEST = 4  # control points of a cubic spline
_DEGREE = 3


@dataclass(frozen=True, eq=False)
class SmoothFit:
    """Uniform cubic splines that follow the components of a curve, clamped at the ends of those that are open.

    The parameter is the share of a component's length for the polygon, and of the number of segments for its spline.
    """

    curve: Curve  # the polygons
    points: tuple[FloatArray, ...]  # control points (de Boor points) of each component's spline, (k, 3)

    @cached_property
    def error(self) -> float:
        """The largest distance between splines and polygons at the same parameter.

        It is taken over the polygons' vertices and eight points of every segment.
        """
        polygon, spline = self._compared
        return float(np.linalg.norm(spline.vertices - polygon.vertices, axis=1).max())

    @cached_property
    def gap(self) -> float:
        """The least distance between strands of the polygons, inf if it is more than twice the error."""
        return strand_gap(self.curve, 2 * self.error)

    @cached_property
    def proved(self) -> bool:
        """Whether the straight motion of the polygons onto the splines is proved free of contact: the knot is the same.

        It takes the points that `error` looks at from the polygons' edges to polygons in the splines.
        """
        polygon, spline = self._compared
        return is_free(polygon.mesh, polygon.vertices, spline.vertices)

    @cached_property
    def _compared(self) -> tuple[Curve, Curve]:
        """The polygons with more points on their edges, and the splines' points of the same parameters."""
        vertices = _shares_of_length(self.curve)
        t = []
        for own, points in zip(vertices, self.points, strict=True):
            even = np.arange(count := 8 * len(points)) / count
            # those that do not nearly coincide with vertices
            apart = np.abs(even[:, None] - np.append(own, 1.0)).min(axis=1) > 1e-3 / max(count, len(own))
            t.append(np.sort(np.concatenate([own, even[apart]])))
        mesh = Mesh(tuple(map(len, t)), self.curve.mesh.closed)
        pieces = zip(self.points, t, self.curve.mesh.closed, strict=True)
        spline = np.concatenate([_basis(own, len(points), closed) @ points for points, own, closed in pieces])
        return Curve(_on_polygon(self.curve, t), mesh), Curve(spline, mesh)


def bezier_points(points: FloatArray, closed: bool = True) -> tuple[FloatArray, FloatArray]:
    """Where segments of a spline meet or end, and from there to the handles of Bézier curves; (joints, 3) each.

    The other handle is as far away on the other side.  A periodic spline has as many joints as control points, (k, 3),
    a clamped one two less.
    """
    knots = _knots(len(points), closed)
    joints = knots[_DEGREE : -_DEGREE - closed]
    spline = BSpline(knots, points[_wrapped(len(points), closed)], _DEGREE)
    return spline(joints), spline(joints, 1) / _DEGREE


def _knots(count: int, closed: bool) -> FloatArray:
    """Knots 0, 1, 2, … with three more on each side: beyond the ends of a period, or at those of a clamped spline."""
    if closed:
        return np.arange(-_DEGREE, count + _DEGREE + 1, dtype=np.float64)
    return np.pad(np.arange(count - _DEGREE + 1, dtype=np.float64), _DEGREE, mode="edge")


def _wrapped(count: int, closed: bool) -> IntArray:
    """The control point that belongs to each B-spline; that of a period's first segment begins before it."""
    return np.arange(-1, count + _DEGREE - 1) % count if closed else np.arange(count)


def _basis(t: FloatArray, count: int, closed: bool) -> sp.csr_array:
    """Values at parameters of the B-splines of so many control points; (parameters, count)."""
    segments = count if closed else count - _DEGREE
    values = sp.csr_array(BSpline.design_matrix(t * segments, _knots(count, closed), _DEGREE))
    owner = _wrapped(count, closed)
    return values @ sp.csr_array((np.ones(len(owner)), (np.arange(len(owner)), owner)))


def fitted(curve: Curve, points: int | None = None) -> SmoothFit:
    """Fit splines to the vertices of each component of a curve in space by least squares.

    ``points``: number of control points of each, 4 or more; None takes as few as are close, at most half the vertices.
    """
    if points is not None:
        return _fit(curve, points)
    radius, fits = free_radius(curve, thickest_radius(curve)), list[SmoothFit]()
    count, most = 8.0, max(8, max(curve.mesh.component_sizes) // 2)
    while not fits or (count < most * 2**0.25 and fits[-1].error > 0.05 * radius):  # less is not seen
        fits.append(_fit(curve, min(int(count), most)))
        count *= 2**0.25
    return min(fits, key=lambda fit: fit.error)


def _fit(curve: Curve, count: int) -> SmoothFit:
    """The splines nearest to the vertices of each component, and a little to points on edges.

    Without the latter control points beside long edges would be arbitrary. The first and the last one of a clamped
    spline are its ends, and those of the polygon.
    """
    even = np.arange(2 * count) / (2 * count)
    on_edges = np.split(_on_polygon(curve, [even] * len(curve.components)), len(curve.components))
    found, shares = list[FloatArray](), _shares_of_length(curve)
    for closed, t, own, inner in zip(curve.mesh.closed, shares, curve.components, on_edges, strict=True):
        a, b = _basis(t, count, closed), _basis(even, count, closed)
        matrix = sp.csc_matrix(a.T @ a + 1e-2 * (b.T @ b))
        right = a.T @ own + 1e-2 * (b.T @ inner)
        if closed:
            found.append(np.asarray(splu(matrix).solve(right)))
        else:
            ends = own[[0, -1]]
            middle = splu(matrix[1:-1, 1:-1]).solve(right[1:-1] - matrix[1:-1][:, [0, -1]] @ ends)
            found.append(np.concatenate([ends[:1], middle, ends[1:]]))
    return SmoothFit(curve, tuple(found))


def _shares_of_length(curve: Curve) -> list[FloatArray]:
    """The part of its component's length that lies before each vertex."""
    position = vertex_positions(curve)
    return [position[s] / length for s, length in zip(curve.mesh.slices, curve.component_lengths, strict=True)]


def _on_polygon(curve: Curve, shares: list[FloatArray]) -> FloatArray:
    """Points of all components at these shares of their lengths; (sum of their numbers, 3)."""
    component = np.repeat(np.arange(len(shares)), [len(t) for t in shares])
    return points_along(curve, component, np.concatenate(shares) * curve.component_lengths[component])
