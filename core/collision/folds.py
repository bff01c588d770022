"""Where a polygon may stop being embedded although no two of its non-neighbour edges meet.

When two neighbour edges fold onto each other, an end of one of them lies on the other: the end that they do not share,
where another edge begins.  This one then meets the edge that it lies on, and is no neighbour of it, but for two cases.
In a triangle it is the neighbour on the other side; and at the end of an arc there is none.  The same is true where an
edge shrinks to a point.  So a polygon is embedded if no two non-neighbour edges meet, no vertex of a triangle lies on
the opposite edge, and no end of an arc lies on the edge after its neighbour, or, if that is the other end, on that.
"""

import numpy as np

from ..curve import Mesh
from ..types import IntArray


def folds(mesh: Mesh) -> IntArray:
    """Vertices and the segments that they must not lie on, as the ends x₀ = x₁ and y₀, y₁; shape (4, folds).

    Segments begin at the tails of their edges.
    """
    triangles = mesh.offsets[:-1][np.asarray(mesh.closed) & (np.asarray(mesh.component_sizes) == 3)]
    after, before = mesh.heads[mesh.outgoing], mesh.tails[mesh.incoming]
    first, last = mesh.ends.T
    u = np.concatenate([triangles, triangles + 1, triangles + 2, first])
    forward = np.stack([u, u, after[u], after[after[u]]])
    backward = np.stack([last, last, before[before[last]], before[last]])
    return np.concatenate([forward, backward], axis=1)
