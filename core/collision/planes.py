"""Pairs of moving segments, and the proof by a separating plane that they don't meet for a while.

Segments x(s) = x₀ + s e and y(r) = y₀ + r f, s, r in [0, 1], whose end points move linearly in time. For a *fixed*
direction n the numbers g_ij(t) = ⟨n, x_i(t) − y_j(t)⟩ at the four pairs of end points are linear in t; if all four
are positive at two times, a plane orthogonal to n separates the segments at every time between.
"""

import numpy as np

from ..types import BoolArray, FloatArray, IntArray

# Bound of the rounding errors in units of Σ|n_k||d_k|. Differences of coordinates are relatively exact, one unit
# roundoff u; a dot product of m ≤ 3 terms adds m, the combination of D, e, f two, the interpolation in time three,
# this bound's own evaluation a few: below 16 u. Twice that is taken.
ROUNDING = 32 * 2.0**-53
UNDERFLOW = 1e-300  # products below 2^-1022 lose absolute, not relative accuracy
_TINY = np.finfo(np.float64).tiny
_PARALLEL = 1e-14  # sin² of the angle below which e × f is mostly rounding


def relative_motion(start: FloatArray, end: FloatArray, vertices: IntArray) -> FloatArray:
    """Return D = x₀ − y₀, e and f at both times; shape (2, 3, m, pairs).

    ``start`` and ``end`` have shape (m, n); ``vertices`` has shape (4, pairs): x₀, x₁, y₀, y₁.
    """
    motion = np.empty((2, 3, len(start), vertices.shape[1]))
    for k, points in enumerate((start, end)):
        x0, x1, y0, y1 = points.take(vertices, axis=1).swapaxes(0, 1)
        np.subtract(x0, y0, out=motion[k, 0])
        np.subtract(x1, x0, out=motion[k, 1])
        np.subtract(y1, y0, out=motion[k, 2])
    return motion


def at_time(values: FloatArray, t: FloatArray) -> FloatArray:
    """Interpolate values at the two times, stacked along the first axis; ``t`` has shape (pairs,)."""
    return np.asarray((1 - t) * values[0] + t * values[1])


def closest_chord(motion: FloatArray) -> FloatArray:
    """Return the vector from the closest point of y to the closest point of x.

    ``motion`` holds D, e, f at one time, shape (3, m, pairs); the result has shape (m, pairs). It is 0 where segments
    in the plane cross. No proof depends on its accuracy.
    """
    D, e, f = motion
    ee, ef, ff = (_dot(u, v) for u, v in ((e, e), (e, f), (f, f)))
    De, Df = _dot(D, e), _dot(D, f)
    # The nearest point of the other edge to each of the four end points.
    r = np.stack([Df, Df + ef]) / np.maximum(ff, _TINY)
    s = np.stack([-De, ef - De]) / np.maximum(ee, _TINY)
    s, r = s.clip(0.0, 1.0), r.clip(0.0, 1.0)
    chords = np.empty((4, *D.shape))
    chords[0] = D - r[0] * f
    chords[1] = D + e - r[1] * f
    chords[2] = D + s[0] * e
    chords[3] = D - f + s[1] * e
    nearest = np.einsum("kmp,kmp->kp", chords, chords).argmin(axis=0)
    chord = np.take_along_axis(chords, nearest[None, None], axis=0)[0]
    sine = ee * ff - ef * ef
    s, r = ef * Df - ff * De, ee * Df - ef * De
    inner = (sine > _PARALLEL * ee * ff) & (s > 0) & (s < sine) & (r > 0) & (r < sine)
    if inner.any():
        chord[:, inner] = _common_normal(D[:, inner], e[:, inner], f[:, inner]) if len(D) == 3 else 0.0
    return np.asarray(chord)


class Separation:
    """The four linear functions g_ij of each pair for fixed directions, lowered by their rounding error.

    Parameters
    ----------
    motion
        D, e, f at both times, shape (2, 3, m, pairs).
    size
        Sum of |D|, |e|, |f| at both times, shape (2, m, pairs).
    direction
        The directions n, shape (m, pairs).
    """

    def __init__(self, motion: FloatArray, size: FloatArray, direction: FloatArray) -> None:
        D, e, f = np.einsum("tkmp,mp->ktp", motion, direction)
        D = D - (ROUNDING * np.einsum("tmp,mp->tp", size, np.abs(direction)) + UNDERFLOW)
        self.values = np.stack([D, D + e, D - f, D + e - f], axis=1)  # (2, 4, pairs)

    def proves(self, t: FloatArray) -> BoolArray:
        """Whether each pair is separated at its time ``t``, and so between any two times where this is true."""
        return np.asarray((at_time(self.values, t) > 0).all(axis=0))

    def time_left(self, t: FloatArray) -> FloatArray:
        """Time from ``t`` until the first of the four functions vanishes; infinite if none falls."""
        fall = self.values[0] - self.values[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            left = np.where(fall > 0, at_time(self.values, t) / fall, np.inf)
        return np.asarray(left.min(axis=0))


def _dot(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("mp,mp->p", u, v))


def _common_normal(D: FloatArray, e: FloatArray, f: FloatArray) -> FloatArray:
    """The part of D along e × f: a good direction even where the difference of two close points is mostly rounding."""
    normal = np.stack([e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]])
    return np.asarray(normal * (_dot(normal, D) / np.maximum(_dot(normal, normal), _TINY)))
