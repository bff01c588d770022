"""Where a polygon may stop being embedded although no two of its non-neighbour edges meet.

When two neighbour edges fold onto each other, an end of one of them lies on the other: the end that they do not share,
where another edge begins.  This one then meets the edge that it lies on, and is no neighbour of it, but for two cases.
In a triangle it is the neighbour on the other side; and at the end of an arc there is none.  The same is true where an
edge shrinks to a point.  So a polygon is embedded if no two non-neighbour edges meet, no vertex of a triangle lies on
the opposite edge, and no end of an arc lies on the edge after its neighbour, or, if that is the other end, on that.
"""

from typing import NamedTuple

import numpy as np

from ..curve import Mesh
from ..types import IntArray


class Folds(NamedTuple):
    """Vertices and the segments that they must not lie on.

    Attributes
    ----------
    edges
        The edge that leads to the vertex, and that of the segment; shape (2, folds).
    corners
        The vertex, twice, and the ends of the segment, as those of two edges one of which has no length; (4, folds).
    """

    edges: IntArray
    corners: IntArray

    @classmethod
    def of(cls, mesh: Mesh) -> "Folds":
        """Those of triangles, and of the ends of arcs."""
        is_triangle = np.asarray(mesh.closed) & (np.asarray(mesh.component_sizes) == 3)
        triangles = mesh.offsets[:-1][is_triangle]
        first, last = mesh.ends.T
        forward = cls._seen(np.concatenate([triangles, triangles + 1, triangles + 2, first]), mesh.outgoing, mesh.heads)
        backward = cls._seen(last, mesh.incoming, mesh.tails)
        return cls(*(np.concatenate(both, axis=1) for both in zip(forward, backward, strict=True)))

    @classmethod
    def _seen(cls, u: IntArray, edge_at: IntArray, end_of: IntArray) -> "Folds":
        """Vertices and the edges after their neighbours, in one of the two directions."""
        v = end_of[edge_at[u]]
        w = end_of[edge_at[v]]
        return cls(np.stack([edge_at[u], edge_at[v]]), np.stack([u, u, v, w]))
