"""Places on a curve, for errors and outcomes to point at."""

import numpy as np

from ..errors import Place
from ..types import FloatArray
from .curve import Curve


def at_vertices(curve: Curve, *vertices: int) -> Place:
    """Some vertices, seen from the first."""
    return Place(vertices, _coordinates(curve.vertices[vertices[0]]))


def at_edges(curve: Curve, edges: tuple[int, ...], position: FloatArray | None = None) -> Place:
    """Some edges, by their ends, seen from ``position``, (m,), or the middle of all."""
    tails = list(edges)
    where = curve.midpoints[tails].mean(axis=0) if position is None else position
    ends = np.stack([curve.mesh.tails[tails], curve.mesh.heads[tails]], axis=1)
    return Place(tuple(dict.fromkeys(ends.ravel().tolist())), _coordinates(where))


def _coordinates(point: FloatArray) -> tuple[float, ...]:
    return tuple(point.tolist())
