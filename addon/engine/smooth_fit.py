"""Smooth curves that follow polygons: cubic splines, as NURBS and Bézier curves, and how far off they are.

Splines are uniform: periodic, or clamped from their first control point to their last, as Blender has them at
*Endpoint*. Their parameter runs from 0 to 1 through segments of equal length.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import BSpline
from scipy.sparse.linalg import splu

from ...core import Curve
from ...core.collision import is_free
from ...core.curve import Mesh
from ...core.curve.distances import points_along, vertex_positions
from ...core.types import FloatArray, IntArray
from .tube import free_radius, strand_gap, thickest_radius

FEWEST = 4  # control points of a cubic spline
_DEGREE = 3
_FIRST = 8  # control points tried first
_GROWTH = 2**0.25  # of their number, until the spline is near enough
_SAMPLES = 8  # per segment of the spline, where it is compared with the polygon
_CLOSE = 0.05  # of the radius of the thickest tube, an error that the eye does not see
_OF_EDGES = 1e-2  # weight of points on edges: without them control points beside long edges would be arbitrary


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
        t = [_merged(own, _SAMPLES * len(points)) for own, points in zip(vertices, self.points, strict=True)]
        mesh = Mesh(tuple(map(len, t)), self.curve.mesh.closed)
        pieces = zip(self.points, t, self.curve.mesh.closed, strict=True)
        spline = np.concatenate([_evaluated(points, own, closed) for points, own, closed in pieces])
        return Curve(_on_polygon(self.curve, t), mesh), Curve(spline, mesh)


def bezier_points(points: FloatArray, closed: bool = True) -> FloatArray:
    """Bézier points of a spline's segments, from end to end; control points (k, 3) to (segments, 4, 3).

    A periodic spline has as many segments as control points, a clamped one three less.
    """
    knots = _knots(len(points), closed)
    joints = knots[_DEGREE:-_DEGREE]
    spline = BSpline(knots, points[_wrapped(len(points), closed)], _DEGREE)
    place, handle = spline(joints), spline(joints, 1) / _DEGREE
    return np.stack([place[:-1], place[:-1] + handle[:-1], place[1:] - handle[1:], place[1:]], axis=1)


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


def _evaluated(points: FloatArray, t: FloatArray, closed: bool) -> FloatArray:
    """Points of a spline with these control points at parameters; (parameters, 3)."""
    return np.asarray(_basis(t, len(points), closed) @ points)


def fitted(curve: Curve, points: int | None = None) -> SmoothFit:
    """Fit splines to the vertices of each component of a curve in space by least squares.

    ``points``: number of control points of each, 4 or more; None takes as few as are close, at most half the vertices.
    """
    if points is not None:
        return SmoothFit(curve, _control_points(curve, points))
    radius, fits = free_radius(curve, thickest_radius(curve)), []
    for count in _counts(max(curve.mesh.component_sizes)):
        fits.append(SmoothFit(curve, _control_points(curve, count)))
        if fits[-1].error <= _CLOSE * radius:
            break
    return min(fits, key=lambda fit: fit.error)


def _counts(vertices: int) -> Iterator[int]:
    count, most = float(_FIRST), max(_FIRST, vertices // 2)
    while count < most:
        yield int(count)
        count *= _GROWTH
    yield most


def _control_points(curve: Curve, count: int) -> tuple[FloatArray, ...]:
    vertices = _shares_of_length(curve)
    even = [np.arange(2 * count) / (2 * count) for _ in vertices]
    on_edges = np.split(_on_polygon(curve, even), len(even))
    return tuple(
        _least_squares(count, closed, (own, c), (t, edges))
        for closed, own, c, t, edges in zip(curve.mesh.closed, vertices, curve.components, even, on_edges, strict=True)
    )


def _least_squares(
    count: int, closed: bool, vertices: tuple[FloatArray, FloatArray], edges: tuple[FloatArray, FloatArray]
) -> FloatArray:
    """Control points nearest to points of given parameters; those on edges count for little.

    The first and the last control point of a clamped spline are its ends, and those of the polygon.
    """
    a, b = _basis(vertices[0], count, closed), _basis(edges[0], count, closed)
    matrix = sp.csc_matrix(a.T @ a + _OF_EDGES * (b.T @ b))
    right = a.T @ vertices[1] + _OF_EDGES * (b.T @ edges[1])
    if closed:
        return np.asarray(splu(matrix).solve(right))
    ends = vertices[1][[0, -1]]
    inner = splu(matrix[1:-1, 1:-1]).solve(right[1:-1] - matrix[1:-1][:, [0, -1]] @ ends)
    return np.concatenate([ends[:1], inner, ends[1:]])


def _shares_of_length(curve: Curve) -> list[FloatArray]:
    """The part of its component's length that lies before each vertex."""
    position = vertex_positions(curve)
    return [position[s] / length for s, length in zip(curve.mesh.slices, curve.component_lengths, strict=True)]


def _on_polygon(curve: Curve, shares: list[FloatArray]) -> FloatArray:
    """Points of all components at these shares of their lengths; (sum of their numbers, 3)."""
    component = np.repeat(np.arange(len(shares)), [len(t) for t in shares])
    return points_along(curve, component, np.concatenate(shares) * curve.component_lengths[component])


def _merged(own: FloatArray, count: int) -> FloatArray:
    """Parameters of vertices, and evenly spread ones that do not nearly coincide with them."""
    even = np.arange(count) / count
    apart = np.abs(even[:, None] - np.append(own, 1.0)).min(axis=1) > 1e-3 / max(count, len(own))
    return np.sort(np.concatenate([own, even[apart]]))
