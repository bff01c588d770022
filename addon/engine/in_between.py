"""More keys where a curve turns far from one to the next: straight lines between two rings make the tube thinner."""

import numpy as np

from ...core.curve import Mesh
from ...core.types import FloatArray
from .ribbon import tangents

_COSINE = float(np.cos(np.radians(30.0)))  # of the angle from key to key, which costs 3 % of the radius halfway
_HALVINGS = 5


def places_between(points: FloatArray, mesh: Mesh) -> FloatArray:
    """Places among keys, 2.5 halfway between the third and the fourth, between which tangents turn by 30° at most.

    No gap is halved more than five times: what turns through itself is never smooth.

    Parameters
    ----------
    points
        Vertices of polygons at every key, (keys, n, 3).
    mesh
        Their connectivity.
    """
    places = np.arange(len(points), dtype=np.float64)
    for _ in range(_HALVINGS):
        far = _least_cosines(interpolated(points, places), mesh) < _COSINE
        if not far.any():
            break
        places = np.sort(np.concatenate([places, 0.5 * (places[:-1] + places[1:])[far]]))
    return places


def interpolated(values: FloatArray, places: FloatArray) -> FloatArray:
    """Values at places among keys; (keys, ...) to (places, ...)."""
    before = np.minimum(places.astype(np.intp), max(len(values) - 2, 0))
    after = np.minimum(before + 1, len(values) - 1)
    share = (places - before).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray((1 - share) * values[before] + share * values[after])


def _least_cosines(points: FloatArray, mesh: Mesh) -> FloatArray:
    """Cosines of the largest angles that tangents turn by from each key to the next; (keys - 1,)."""
    pieces = zip(mesh.slices, mesh.closed, strict=True)
    tau = np.concatenate([tangents(points[:, s], closed) for s, closed in pieces], axis=1)
    return np.asarray(np.einsum("kni,kni->kn", tau[:-1], tau[1:]).min(axis=1))
