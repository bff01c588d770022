"""Gauss–Legendre quadrature on [0, 1]."""

from functools import lru_cache

import numpy as np

from .types import FloatArray, frozen


@lru_cache(maxsize=64)
def gauss_legendre(points: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights on [0, 1], each of shape (points,), exact for polynomials of degree 2·points − 1."""
    x, w = np.polynomial.legendre.leggauss(points)  # type: ignore[no-untyped-call]
    return frozen(0.5 * (x + 1.0)), frozen(0.5 * w)
