"""Values in between: of points on the edges of a polygon, and of shapes between keys."""

import numpy as np
import numpy.typing as npt

from ...core.curve import Mesh
from ...core.tube import tangents
from ...core.types import FloatArray

_COSINE = float(np.cos(np.radians(30.0)))  # of the angle from key to key, which costs a tube 3 % of its radius halfway
_HALVINGS = 5


def along(values: npt.NDArray[np.float32], size: int, closed: bool) -> FloatArray:
    """Values of a spline's control points, (k,), at so many points drawn for it, which lie evenly between those."""
    if closed:
        return np.interp(np.arange(size) * len(values) / size, np.arange(len(values)), values, period=len(values))
    return np.interp(np.linspace(0.0, len(values) - 1, size), np.arange(len(values)), values)


def on_refined(values: FloatArray, lengths: FloatArray, refined: FloatArray, closed: bool) -> FloatArray:
    """Values at the vertices of a refined polygon, linear along the edges of the original.

    ``values``: at the original vertices, (n,); ``lengths``, ``refined``: edge lengths of both polygons, which run
    through the same points from the same vertex.
    """
    old, new = (np.concatenate([[0.0], np.cumsum(each)]) / each.sum() for each in (lengths, refined))
    # a vertex met a rounding error too early gets its neighbour's value with a weight of 1e-15: none in 32 bits
    return np.interp(new[:-1], old[:-1], values, period=1.0) if closed else np.interp(new, old, values)


def interpolated(values: FloatArray, places: FloatArray) -> FloatArray:
    """Values at places among keys, 2.5 halfway between the third and the fourth; (keys, ...) to (places, ...)."""
    before = np.minimum(places.astype(np.intp), max(len(values) - 2, 0))
    after = np.minimum(before + 1, len(values) - 1)
    share = (places - before).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray((1 - share) * values[before] + share * values[after])


def places_between(points: FloatArray, mesh: Mesh) -> FloatArray:
    """Places among keys, 2.5 halfway between the third and the fourth, between which tangents turn by 30° at most.

    Straight lines between two rings make the tube thinner. No gap is halved more than five times: what turns through
    itself is never smooth. Points: (keys, n, 3).
    """
    places = np.arange(len(points), dtype=np.float64)
    for _ in range(_HALVINGS):
        shapes, pieces = interpolated(points, places), zip(mesh.slices, mesh.closed, strict=True)
        tau = np.concatenate([tangents(shapes[:, s], closed) for s, closed in pieces], axis=1)
        far = np.einsum("kni,kni->kn", tau[:-1], tau[1:]).min(axis=1) < _COSINE
        if not far.any():
            break
        places = np.sort(np.concatenate([places, 0.5 * (places[:-1] + places[1:])[far]]))
    return places
