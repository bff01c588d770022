"""Values in between: of points on the edges of a polygon, and of shapes between keys."""

import numpy as np
import numpy.typing as npt

from ...core.types import FloatArray


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
