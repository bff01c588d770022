"""Inner and vector products of arrays of vectors, coordinates first: the shape (3, ...) keeps loops contiguous."""

import numpy as np

from ...types import FloatArray


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """⟨a, b⟩; shapes (3, ...) -> (...)."""
    return np.asarray(np.einsum("i...,i...->...", a, b))


def norm(a: FloatArray) -> FloatArray:
    """|a|; shapes (3, ...) -> (...)."""
    return np.asarray(np.sqrt(dot(a, a)))


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """a × b; shapes (3, ...) -> (3, ...)."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
