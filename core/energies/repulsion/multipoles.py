"""Φ of clusters from afar, by their moments up to the second order, and its derivatives with respect to the point.

Φ ≈ W K + ½ ⟨Q, ∇²K⟩ = r⁻ᵖ (W − p/2 tr Q/r² + p (p + 2)/2 dᵀQd/r⁴),   K = 1/rᵖ, d = x − c
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...types import FloatArray
from .simplices import Potentials
from .vectors import dot

ROWS, COLUMNS = np.array([0, 1, 2, 0, 0, 1]), np.array([0, 1, 2, 1, 2, 2])
_XX, _YY, _ZZ, _XY, _XZ, _YZ = range(6)


@dataclass(frozen=True, eq=False)
class Multipoles:
    """Clusters seen from points.

    Parameters
    ----------
    p
        Exponent of the kernel.
    d
        From the centroids c to the points; shape (3, k, points).
    size
        W = ∫ dA; shape (k, 1).
    spread
        Q = ∫ (y − c)(y − c)ᵀ dA as xx, yy, zz, xy, xz, yz; shape (6, k, 1).
    """

    p: int
    d: FloatArray
    size: FloatArray
    spread: FloatArray

    def potential(self) -> Potentials:
        """Φ and ∇Φ."""
        value = self.size - 0.5 * self.p * self._trace + self._half * self._along
        return Potentials(self._kernel * value, self._radial * self.d + self._other * self._spread_d)

    def change(self, v: FloatArray) -> Potentials:
        """The derivatives of Φ and ∇Φ as the points move with velocities v."""
        p, s = self.p, self._s
        rate = s * dot(self.d, v)  # of log r
        slope_rate = -2.0 * self._half * rate * self._trace
        slope_rate -= (p + 4) * self._half * (2.0 * (s * s) * dot(self._spread_d, v) - 4.0 * rate * self._along)
        radial_rate = s * self._kernel * slope_rate - (p + 2) * rate * self._radial
        gradient = radial_rate * self.d + self._radial * v
        gradient += self._other * (_product(self.spread, v) - (p + 4) * rate * self._spread_d)
        value = self._radial * dot(self.d, v) + self._other * dot(self._spread_d, v)
        return Potentials(value, gradient)

    @cached_property
    def _s(self) -> FloatArray:
        """1/r²."""
        return np.asarray(1.0 / dot(self.d, self.d))

    @cached_property
    def _kernel(self) -> FloatArray:
        return np.asarray(self._s ** (0.5 * self.p))

    @property
    def _half(self) -> float:
        return 0.5 * self.p * (self.p + 2)

    @cached_property
    def _spread_d(self) -> FloatArray:
        """Q d."""
        return _product(self.spread, self.d)

    @cached_property
    def _trace(self) -> FloatArray:
        """tr Q/r²."""
        return np.asarray((self.spread[_XX] + self.spread[_YY] + self.spread[_ZZ]) * self._s)

    @cached_property
    def _along(self) -> FloatArray:
        """dᵀQd/r⁴."""
        return np.asarray(dot(self.d, self._spread_d) * (self._s * self._s))

    @cached_property
    def _radial(self) -> FloatArray:
        """The coefficient of d in ∇Φ."""
        slope = self._half * self._trace - (self.p + 4) * self._half * self._along - self.p * self.size
        return np.asarray(self._s * self._kernel * slope)

    @cached_property
    def _other(self) -> FloatArray:
        """The coefficient of Q d in ∇Φ."""
        return np.asarray(2.0 * self._half * (self._s * self._s) * self._kernel)


def _product(q: FloatArray, d: FloatArray) -> FloatArray:
    """Q d of symmetric matrices, shape (6, ...), and vectors, shape (3, ...)."""
    return np.stack(
        [
            q[_XX] * d[0] + q[_XY] * d[1] + q[_XZ] * d[2],
            q[_XY] * d[0] + q[_YY] * d[1] + q[_YZ] * d[2],
            q[_XZ] * d[0] + q[_YZ] * d[1] + q[_ZZ] * d[2],
        ]
    )
