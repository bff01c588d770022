"""Values of points carried over to a refined polygon: new points lie on edges and get values in between."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...core import Curve
from ...core.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Places:
    """Where the vertices of a refined component lie on the original one: on which edge, and how far along it.

    Where the component is open, its last vertex is as far along the last edge as that goes.
    """

    edge: IntArray
    fraction: FloatArray

    def values(self, original: FloatArray) -> FloatArray:
        """Interpolate values given at the original vertices, shape (n,), linearly along the edges."""
        heads = np.roll(original, -1)
        return np.asarray((1 - self.fraction) * original[self.edge] + self.fraction * heads[self.edge])


def places(original: Curve, refined: Curve) -> tuple[Places, ...]:
    """Find each component's refined vertices on the original polygon, which both run through from the same vertex."""
    pieces = zip(original.mesh.edge_slices, refined.mesh.edge_slices, original.mesh.closed, strict=True)
    ell, finer = original.edge_lengths, refined.edge_lengths
    return tuple(_on_edges(ell[old], finer[new], closed) for old, new, closed in pieces)


def _on_edges(original: FloatArray, refined: FloatArray, closed: bool) -> Places:
    """Compare the places of vertices along the polygon, as shares of its length, which is the same for both."""
    corners = np.concatenate([[0.0], np.cumsum(original)]) / original.sum()
    vertices = np.concatenate([[0.0], np.cumsum(refined)]) / refined.sum()
    # A corner met a rounding error too early gets its neighbour's value with a weight of 1e-15: none in 32 bits.
    place = np.interp(vertices[:-1] if closed else vertices, corners, np.arange(len(corners)))
    edge = np.minimum(place.astype(np.intp), len(original) - 1)
    return Places(edge, place - edge)


def along(values: npt.NDArray[np.float32], size: int, closed: bool) -> FloatArray:
    """Values of a spline's control points, (k,), at so many points drawn for it, which lie evenly between those."""
    if closed:
        return np.interp(np.arange(size) * len(values) / size, np.arange(len(values)), values, period=len(values))
    return np.interp(np.linspace(0.0, len(values) - 1, size), np.arange(len(values)), values)
