"""March pairs of moving segments, or of a segment and a triangle, from separating plane to separating plane."""

import numpy as np

from ..types import FloatArray, IntArray
from .chords import closest_chord
from .planes import Separation, at_time, relative_motion

_ROUNDS = 20
_PATIENCE = 1 / 3  # so many pairs per round done are not worth another round: the exact decision is as quick
_SHORT = 0.01  # a step that adds less than this part of the time reached calls for the exact decision
_SHARE = 1 - 2.0**-6  # part of the way to the plane's own contact that a step goes, to stay apart for the next plane


def march(start: FloatArray, end: FloatArray, vertices: IntArray, reached: FloatArray, limit: float) -> FloatArray:
    """Prove each pair free of contact for as long as planes make good progress.

    Parameters
    ----------
    start, end
        Vertices of the leg, shape (m, n), entries of at most 1 in size.
    vertices
        The pairs' vertices x₀, x₁, y₀, y₁, shape (4, pairs), and y₂ of triangles, shape (5, pairs).
    reached
        Times up to which the pairs are known to be free, shape (pairs,).
    limit
        Time beyond which nothing is asked.

    Returns
    -------
    reached
        The new times, at least ``limit`` where nothing stands in the way.
    """
    reached = reached.copy()
    active = np.flatnonzero(reached < limit)
    motion = relative_motion(start, end, vertices[:, active])
    size = np.abs(motion).sum(axis=1)
    t = reached[active]
    for k in range(_ROUNDS):
        if active.size <= _PATIENCE * k:
            break
        planes = Separation(motion, size, closest_chord(at_time(motion, t)))
        further = np.minimum(t + _SHARE * planes.time_left(t), 1.0)
        moved = planes.proves(t) & planes.proves(further)
        further = np.where(moved, further, t)
        reached[active] = further
        go_on = moved & (further < limit) & (further - t > _SHORT * further)
        active, motion, size, t = active[go_on], motion[..., go_on], size[..., go_on], further[go_on]
    return reached
