"""The shortest way between a segment and another one, or a triangle: the direction of the plane that may separate them.

Segment x₀ + s e; segment y₀ + r f or triangle y₀ + r f + q g; D = x₀ − y₀. No proof depends on the accuracy of a chord.
"""

import numpy as np

from ..types import FloatArray

_TINY = np.finfo(np.float64).tiny
_PARALLEL = 1e-14  # sin² of the angle below which a cross product is mostly rounding


def closest_chord(motion: FloatArray) -> FloatArray:
    """Return the vector from the closest point of y to the closest point of x.

    ``motion`` holds D, e, f, and g for triangles, at one time, shape (3 or 4, m, pairs); the result has shape
    (m, pairs). It is 0 where segments in the plane cross, and of no use where a segment pierces a triangle.
    """
    if len(motion) == 3:
        return _to_segment(*motion)
    D, e, f, g = motion
    edges = [np.concatenate(each, axis=1) for each in ((D, D, D - f), (e, e, e), (f, g, g - f))]
    to_edges = np.split(_to_segment(*edges), 3, axis=1)
    return _shortest(np.stack([*to_edges, _to_face(D, f, g), _to_face(D + e, f, g)]))


def _to_segment(D: FloatArray, e: FloatArray, f: FloatArray) -> FloatArray:
    """From the closest point of a segment to that of the other; 0 where segments in the plane cross."""
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
    chord = _shortest(chords)
    sine = ee * ff - ef * ef
    s, r = ef * Df - ff * De, ee * Df - ef * De
    inner = (sine > _PARALLEL * ee * ff) & (s > 0) & (s < sine) & (r > 0) & (r < sine)
    if inner.any():
        chord[:, inner] = _along(_cross(e[:, inner], f[:, inner]), D[:, inner]) if len(D) == 3 else 0.0
    return chord


def _to_face(D: FloatArray, f: FloatArray, g: FloatArray) -> FloatArray:
    """From the foot of x₀ in a triangle to x₀; D, no shorter than the chord, where the foot is not in the triangle."""
    normal = _cross(f, g)
    whole = _dot(normal, normal)
    r, q = _dot(_cross(D, g), normal), _dot(_cross(f, D), normal)
    inside = (whole > _PARALLEL * _dot(f, f) * _dot(g, g)) & (r > 0) & (q > 0) & (r + q < whole)
    return np.where(inside, _along(normal, D), D)


def _shortest(chords: FloatArray) -> FloatArray:
    """The shortest of several vectors of each pair; shapes (k, m, pairs) -> (m, pairs)."""
    nearest = np.einsum("kmp,kmp->kp", chords, chords).argmin(axis=0)
    return np.asarray(np.take_along_axis(chords, nearest[None, None], axis=0)[0])


def _dot(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("mp,mp->p", u, v))


def _cross(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])


def _along(normal: FloatArray, D: FloatArray) -> FloatArray:
    """The part of D along a normal: a good direction even where the difference of close points is mostly rounding."""
    return np.asarray(normal * (_dot(normal, D) / np.maximum(_dot(normal, normal), _TINY)))
