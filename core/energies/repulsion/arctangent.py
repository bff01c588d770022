"""g(N², D) = atan2(N, D)/N: what solid angles over heights and angles over distances have in common."""

from typing import NamedTuple

import numpy as np

from ...types import BoolArray, FloatArray
from ..moments import tail_cube, tail_square

_FLAT = 1e-5  # N²/D² below which series take the place of a difference over N², which has lost five digits there
_FLAT_TWICE = 1e-3  # and of a second such difference, which has lost six


class ArctangentQuotient(NamedTuple):
    """g and its first derivatives, all of one shape; it is analytic, with g = 1/D at N = 0 < D."""

    value: FloatArray
    by_square: FloatArray
    by_d: FloatArray

    @classmethod
    def at(cls, square: FloatArray, d: FloatArray) -> "ArctangentQuotient":
        """For arrays N² > 0, which may be tiny, and D."""
        n, inverse = np.sqrt(square), 1.0 / (square + d * d)
        value = np.arctan2(n, d) / n
        by_square = (d * inverse - value) / (2.0 * square)
        flat = _is_flat(square, d, _FLAT)
        by_square[flat] = -tail_square(n[flat] / d[flat]) / d[flat] ** 3
        return cls(value, by_square, -inverse)

    def change(
        self, square: FloatArray, d: FloatArray, square_change: FloatArray, d_change: FloatArray
    ) -> "ArctangentQuotient":
        """Its derivative, where those of N² and D are given."""
        inverse_square = self.by_d**2
        twice = -(d * inverse_square + 3.0 * self.by_square) / (2.0 * square)
        flat = _is_flat(square, d, _FLAT_TWICE)
        x = np.sqrt(square[flat]) / d[flat]
        twice[flat] = 2.0 * tail_cube(x, tail_square(x)) / d[flat] ** 5
        return ArctangentQuotient(
            self.by_square * square_change + self.by_d * d_change,
            twice * square_change + inverse_square * d_change,
            inverse_square * (square_change + 2.0 * d * d_change),
        )


def _is_flat(square: FloatArray, d: FloatArray, limit: float) -> BoolArray:
    return np.asarray((d > 0.0) & (square < limit * d * d))
