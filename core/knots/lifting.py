"""Closed curves in the plane lifted into space: heights at some places, smooth ramps between them."""

from itertools import pairwise

import numpy as np

from ..types import FloatArray

_RAMP = 10  # edges from one place to the next, at least


def lifted(points: FloatArray, at: FloatArray, lift: FloatArray, nearest: float) -> FloatArray:
    """Lift a closed polygon, shape (n, 2), without moving it sideways.

    Parameters
    ----------
    points
        Its vertices.
    at
        Edge and fraction of it, as one number, of each place where the height is given; sorted, shape (k,).
    lift
        The heights, shape (k,).
    nearest
        Vertices nearer than that to one of the places give way to it.

    Returns
    -------
    FloatArray
        Vertices of a finer polygon, shape (m, 3).
    """
    closed = np.concatenate([points, points[:1]])
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    marks = np.interp(at, np.arange(len(closed)), arc)
    places = _places(arc, marks, nearest)
    plane = [np.interp(places, arc, x) for x in closed.T]
    if not len(marks):
        return np.column_stack([*plane, np.zeros(len(places))])
    ends = np.concatenate([marks[-1:] - arc[-1], marks, marks[:1] + arc[-1]])
    k = np.searchsorted(ends, places, side="right") - 1
    u = (places - ends[k]) / (ends[k + 1] - ends[k])
    low, high = np.take(lift, k - 1, mode="wrap"), np.take(lift, k, mode="wrap")
    return np.column_stack([*plane, low + (high - low) * u * u * (3.0 - 2.0 * u)])


def _places(arc: FloatArray, marks: FloatArray, nearest: float) -> FloatArray:
    """Where the lifted curve has vertices: at passes, at the drawing's vertices, and between them; sorted."""
    length = arc[-1]
    places = _with(marks, arc[:-1], nearest, length)
    ends = np.append(marks, marks[0] + length) if len(marks) else np.array([0.0, length])
    ramps = [np.linspace(a, b, _RAMP, endpoint=False)[1:] for a, b in pairwise(ends)]
    for ramp in ramps:
        places = _with(places, ramp % length, 0.5 * (ramp[1] - ramp[0]), length)
    return places


def _with(places: FloatArray, more: FloatArray, nearest: float, length: float) -> FloatArray:
    """Add places on a closed curve, but for those that are near others; sorted."""
    if not len(places):
        return more
    gaps = np.abs(more[:, None] - places[None, :])
    return np.sort(np.concatenate([places, more[np.minimum(gaps, length - gaps).min(axis=1) > nearest]]))
