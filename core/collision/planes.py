"""Moving segments, and the proof by a separating plane that one does not meet another, or a triangle, for a while.

A segment x₀ + s e and a segment y₀ + r f, or a triangle y₀ + r f + q g, whose vertices move linearly in time. For a
*fixed* direction n the numbers ⟨n, x_i(t) − y_j(t)⟩ at the four, or six, pairs of vertices are linear in t; if all are
positive at two times, a plane orthogonal to n separates the two at every time between.
"""

import numpy as np

from ..types import BoolArray, FloatArray, IntArray

# Bound of the rounding errors in units of Σ|n_k||d_k|. Differences of coordinates are relatively exact, one unit
# roundoff u; a dot product of m ≤ 3 terms adds m, the combination of D, e and f or g two, the interpolation in time
# three, this bound's own evaluation a few: below 16 u. Twice that is taken.
ROUNDING = 32 * 2.0**-53
UNDERFLOW = 1e-300  # products below 2^-1022 lose absolute, not relative accuracy


def relative_motion(start: FloatArray, end: FloatArray, vertices: IntArray) -> FloatArray:
    """Return D = x₀ − y₀, e and f, for triangles g too, at both times; shape (2, 3 or 4, m, pairs).

    ``start`` and ``end`` have shape (m, n); ``vertices`` has shape (4, pairs) or (5, pairs): x₀, x₁, y₀, y₁ and y₂.
    """
    motion = np.empty((2, len(vertices) - 1, len(start), vertices.shape[1]))
    for k, points in enumerate((start, end)):
        x0, x1, y0, *others = points.take(vertices, axis=1).swapaxes(0, 1)
        np.subtract(x0, y0, out=motion[k, 0])
        np.subtract(x1, x0, out=motion[k, 1])
        for span, y in zip(motion[k, 2:], others, strict=True):
            np.subtract(y, y0, out=span)
    return motion


def at_time(values: FloatArray, t: FloatArray) -> FloatArray:
    """Interpolate values at the two times, stacked along the first axis; ``t`` has shape (pairs,)."""
    return np.asarray((1 - t) * values[0] + t * values[1])


class Separation:
    """The linear functions ⟨n, x_i − y_j⟩ of each pair for fixed directions, lowered by their rounding errors.

    Parameters
    ----------
    motion
        As `relative_motion` gives it, shape (2, 3 or 4, m, pairs).
    size
        Sum of the absolute values of its vectors at both times, shape (2, m, pairs).
    direction
        The directions n, shape (m, pairs).
    """

    def __init__(self, motion: FloatArray, size: FloatArray, direction: FloatArray) -> None:
        D, e, *spans = np.einsum("tkmp,mp->ktp", motion, direction)
        D = D - (ROUNDING * np.einsum("tmp,mp->tp", size, np.abs(direction)) + UNDERFLOW)
        ends = (D, D + e)
        self.values = np.stack([*ends, *(x - y for y in spans for x in ends)], axis=1)  # (2, 4 or 6, pairs)

    def proves(self, t: FloatArray) -> BoolArray:
        """Whether each pair is separated at its time ``t``, and so between any two times where this is true."""
        return np.asarray((at_time(self.values, t) > 0).all(axis=0))

    def time_left(self, t: FloatArray) -> FloatArray:
        """Time from ``t`` until the first of the functions vanishes; infinite if none falls."""
        fall = self.values[0] - self.values[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            left = np.where(fall > 0, at_time(self.values, t) / fall, np.inf)
        return np.asarray(left.min(axis=0))
