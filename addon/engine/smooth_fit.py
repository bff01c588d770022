"""Smooth curves that follow polygons: periodic cubic splines, as NURBS and Bézier curves, and how far off they are."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ...core import Curve
from ...core.collision import is_free
from ...core.curve import Mesh
from ...core.curve.distances import arc_positions, points_along
from ...core.types import FloatArray, IntArray
from .tube import free_radius, strand_gap, thickest_radius

FEWEST = 4  # control points of a cubic spline
_FIRST = 8  # control points tried first
_GROWTH = 2**0.25  # of their number, until the spline is near enough
_SAMPLES = 8  # per segment of the spline, where it is compared with the polygon
_CLOSE = 0.05  # of the radius of the thickest tube, an error that the eye does not see
_OF_EDGES = 1e-2  # weight of points on edges: without them control points beside long edges would be anywhere
_TO_BEZIER = np.array([[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]]) / 6.0


@dataclass(frozen=True, eq=False)
class SmoothFit:
    """Uniform periodic cubic splines that follow the components of a curve.

    The parameter is the share of a component's length for the polygon, and of the number of segments for its spline.

    Attributes
    ----------
    curve
        The polygons.
    points
        Control points (de Boor points) of each component's spline, (k, 3).
    """

    curve: Curve
    points: tuple[FloatArray, ...]

    @cached_property
    def bezier(self) -> tuple[FloatArray, ...]:
        """Bézier points of each component's segments, from end to end; (k, 4, 3)."""
        return tuple(map(bezier_points, self.points))

    @cached_property
    def error(self) -> float:
        """The furthest that splines and polygons are from each other at the same parameter.

        Looked at are the polygons' vertices and eight points of every segment.
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

        What moves is the polygons with more points on their edges; where it arrives is polygons in the splines, with
        the points that `error` looks at.
        """
        polygon, spline = self._compared
        return is_free(polygon.mesh, polygon.vertices, spline.vertices)

    @cached_property
    def _compared(self) -> tuple[Curve, Curve]:
        """The polygons with more points on their edges, and the splines' points of the same parameters."""
        vertices = _shares_of_length(self.curve)
        t = [_merged(own, _SAMPLES * len(points)) for own, points in zip(vertices, self.points, strict=True)]
        mesh = Mesh(tuple(map(len, t)))
        spline = np.concatenate([_evaluated(each, own) for each, own in zip(self.bezier, t, strict=True)])
        return Curve(_on_polygon(self.curve, t), mesh), Curve(spline, mesh)


def fitted(curve: Curve, points: int | None = None) -> SmoothFit:
    """Fit splines to the vertices of each component by least squares.

    Parameters
    ----------
    curve
        The polygons, in space.
    points
        Number of control points of each spline, at least 4; None takes as few as are close, and at most half as many as
        there are vertices.
    """
    if points is not None:
        return SmoothFit(curve, _control_points(curve, points))
    radius, fits = free_radius(curve, thickest_radius(curve)), []
    for count in _counts(max(curve.mesh.component_sizes)):
        fits.append(SmoothFit(curve, _control_points(curve, count)))
        if fits[-1].error <= _CLOSE * radius:
            break
    return min(fits, key=lambda fit: fit.error)


def bezier_points(points: FloatArray) -> FloatArray:
    """Bézier points of the segments of a periodic uniform cubic B-spline; (k, 3) to (k, 4, 3)."""
    return np.asarray(_TO_BEZIER @ np.stack([np.roll(points, -k, axis=0) for k in range(-1, 3)], axis=1))


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
        _least_squares(count, (own, c), (t, edges))
        for own, c, t, edges in zip(vertices, curve.components, even, on_edges, strict=True)
    )


def _least_squares(
    count: int, vertices: tuple[FloatArray, FloatArray], edges: tuple[FloatArray, FloatArray]
) -> FloatArray:
    """Control points nearest to points of given parameters; those on edges count for little."""
    a, b = _basis(vertices[0], count), _basis(edges[0], count)
    matrix = a.T @ a + _OF_EDGES * (b.T @ b)
    return np.asarray(splu(sp.csc_matrix(matrix)).solve(a.T @ vertices[1] + _OF_EDGES * (b.T @ edges[1])))


def _basis(t: FloatArray, count: int) -> sp.csr_array:
    """Values of the cubic B-splines at parameters; (parameters, count)."""
    segment, u = _segments(t, count)
    values = _bernstein(u) @ _TO_BEZIER
    rows = np.repeat(np.arange(len(t)), 4)
    columns = (segment[:, None] + np.arange(-1, 3)) % count
    return sp.csr_array((values.ravel(), (rows, columns.ravel())), shape=(len(t), count))


def _evaluated(bezier: FloatArray, t: FloatArray) -> FloatArray:
    segment, u = _segments(t, len(bezier))
    return np.asarray(np.einsum("ni,nij->nj", _bernstein(u), bezier[segment]))


def _segments(t: FloatArray, count: int) -> tuple[IntArray, FloatArray]:
    """Number of the segment that a parameter lies in, and how far along it."""
    segment = np.minimum((t * count).astype(np.intp), count - 1)
    return segment, t * count - segment


def _bernstein(u: FloatArray) -> FloatArray:
    v = 1.0 - u
    return np.stack([v**3, 3 * u * v**2, 3 * u**2 * v, u**3], axis=-1)


def _shares_of_length(curve: Curve) -> list[FloatArray]:
    """The part of its component's length that lies before each vertex."""
    position = arc_positions(curve, 0.0)
    return [position[s] / curve.edge_lengths[s].sum() for s in curve.mesh.slices]


def _on_polygon(curve: Curve, shares: list[FloatArray]) -> FloatArray:
    """Points of all components where so much of the length is passed; (sum of their numbers, 3)."""
    component = np.repeat(np.arange(len(shares)), [len(t) for t in shares])
    lengths = np.array([curve.edge_lengths[s].sum() for s in curve.mesh.slices])
    return points_along(curve, component, np.concatenate(shares) * lengths[component])


def _merged(own: FloatArray, count: int) -> FloatArray:
    """Parameters of vertices, and evenly spread ones that are not as good as the same."""
    even = np.arange(count) / count
    apart = np.abs(even[:, None] - np.append(own, 1.0)).min(axis=1) > 1e-3 / max(count, len(own))
    return np.sort(np.concatenate([own, even[apart]]))
