"""Möbius maps of R^m up to similarities: the point that they send to infinity, as a rotation of the sphere.

Stereographic projection to the sphere S^m, a rotation in the plane of the north pole and a direction v/|v|, and
projection back.  With the cosine c and the sine |v| of half the angle this is

    y = ((c² + |v|²) x + (c (|x|² − 1) − 2 ⟨v, x⟩) v) / D,    D = c² + 2 c ⟨v, x⟩ + |v|² |x|²,

a map for each q = (c, v) ≠ 0, the same for all multiples of q.  The pole −c v/|v|² is where D = 0; at (1, 0) it is the
point at infinity, and the map the identity.  Every Möbius map that keeps the orientation is one of these and then a
similarity.
"""

import numpy as np

from ..types import FloatArray

NEAREST = 1e-24  # the least D: what lies on the pole goes far away, not to infinity


def moebius_image(points: FloatArray, q: FloatArray) -> FloatArray:
    """Images of points, shape (n, m), under the map of ``q``, shape (m + 1,)."""
    c, v = float(q[0]), q[1:]
    along, square = points @ v, np.einsum("ij,ij->i", points, points)
    numerator = (q @ q) * points + np.multiply.outer(c * (square - 1.0) - 2.0 * along, v)
    return np.asarray(numerator / _denominator(q, along, square)[:, None])


def moebius_pullback(points: FloatArray, q: FloatArray, covector: FloatArray) -> FloatArray:
    """From a function's derivative by the images of points, shape (n, m), to that by ``q``, shape (m + 1,)."""
    c, v = float(q[0]), q[1:]
    along, square = points @ v, np.einsum("ij,ij->i", points, points)
    g = covector / _denominator(q, along, square)[:, None]
    shrink = -np.einsum("ij,ij->i", g, moebius_image(points, q))  # the weight of dD
    on_points, on_v = float(np.sum(points * g)), g @ v
    by_c = 2.0 * c * on_points + on_v @ (square - 1.0) + 2.0 * shrink @ (c + along)
    by_v = 2.0 * (on_points + shrink @ square) * v + 2.0 * (c * shrink - on_v) @ points
    return np.concatenate([[by_c], by_v + (c * (square - 1.0) - 2.0 * along) @ g])


def _denominator(q: FloatArray, along: FloatArray, square: FloatArray) -> FloatArray:
    c, v = q[0], q[1:]
    return np.asarray(np.maximum(c**2 + 2.0 * c * along + (v @ v) * square, NEAREST))
