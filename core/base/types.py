"""Arrays, as they are used throughout the core: their types, and inner products of vectors."""

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.intp]
BoolArray = npt.NDArray[np.bool_]
TINY = float(np.finfo(np.float64).tiny)  # keeps quotients from division by 0
_Scalar = TypeVar("_Scalar", bound=np.generic)


def frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    """Make an array read-only and return it, so that values can be shared without copies."""
    array.setflags(write=False)
    return array


def dot(u: npt.NDArray[Any], v: npt.NDArray[Any]) -> FloatArray:
    """⟨u, v⟩ of vectors along the last axis, not conjugated; shapes (..., m) to (...)."""
    return np.asarray(np.einsum("...i,...i->...", u, v))


def column_dot(u: npt.NDArray[Any], v: npt.NDArray[Any]) -> FloatArray:
    """⟨u, v⟩ of vectors along the first axis, which keeps loops over many contiguous; shapes (m, ...) to (...)."""
    return np.asarray(np.einsum("i...,i...->...", u, v))


def real(values: npt.ArrayLike) -> FloatArray:
    """Copy numbers into an array of doubles; a TypeError, ValueError or OverflowError says why they are none."""
    array = np.array(values)
    if np.iscomplexobj(array):
        raise TypeError("they are complex")
    return array.astype(np.float64, copy=False)


def column_cross(u: npt.NDArray[Any], v: npt.NDArray[Any]) -> FloatArray:
    """u × v of vectors along the first axis, in the plane the only component; shapes (m, ...) to (3 or 1, ...)."""
    if len(u) == 2:
        return np.asarray(u[:1] * v[1:] - u[1:] * v[:1])
    return np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
