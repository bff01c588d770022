"""Values of points carried over to a refined polygon: new points lie on edges and get values in between."""

from dataclasses import dataclass

import numpy as np

from ...core import Curve
from ...core.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Places:
    """Where the vertices of a refined component lie on the original one: on which edge, and how far along it."""

    edge: IntArray
    fraction: FloatArray

    def values(self, original: FloatArray) -> FloatArray:
        """Interpolate values given at the original vertices, shape (n,), linearly along the edges."""
        heads = np.roll(original, -1)
        return np.asarray((1 - self.fraction) * original[self.edge] + self.fraction * heads[self.edge])


def places(original: Curve, refined: Curve) -> tuple[Places, ...]:
    """Find each component's refined vertices on the original polygon, which both run through from the same vertex."""
    slices = zip(original.mesh.slices, refined.mesh.slices, strict=True)
    return tuple(_on_edges(original.edge_lengths[old], refined.edge_lengths[new]) for old, new in slices)


def _on_edges(original: FloatArray, refined: FloatArray) -> Places:
    """Compare the places of vertices along the polygon, as shares of its length, which is the same for both."""
    corners = np.concatenate([[0.0], np.cumsum(original)]) / original.sum()
    vertices = np.concatenate([[0.0], np.cumsum(refined)[:-1]]) / refined.sum()
    # A corner met a rounding error too early gets its neighbour's value with a weight of 1e-15: none in 32 bits.
    place = np.interp(vertices, corners, np.arange(len(corners)))
    edge = np.minimum(place.astype(np.intp), len(original) - 1)
    return Places(edge, place - edge)
