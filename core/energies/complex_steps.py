"""Derivatives along vectors by complex steps, exact to rounding: no difference is formed.

    d/dt f(x + t v) = Im f(x + iεv)/ε  at t = 0

for f analytic and real on real arguments, with ε so small that its square vanishes beside any number (Squire and Trapp,
SIAM Review 40, 1998).  Comparisons go by real parts, as NumPy orders complex numbers.
"""

import numpy as np

from ..types import FloatArray

STEP = 1e-100


def stepped(x: FloatArray, v: FloatArray) -> FloatArray:
    """x + iεv."""
    return np.asarray(x + STEP * 1j * v)


def change(f: FloatArray) -> FloatArray:
    """The derivative along v, from f(x + iεv)."""
    return np.asarray(f.imag / STEP)


def arctan2(y: FloatArray, x: FloatArray) -> FloatArray:
    """NumPy's arctan2, continued to complex steps."""
    angle = np.arctan2(y.real, x.real)
    if np.iscomplexobj(x):
        angle = angle + 1j * (x.real * y.imag - y.real * x.imag) / (x.real**2 + y.real**2)
    return np.asarray(angle)
