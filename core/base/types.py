"""Array types used throughout the core."""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.intp]
BoolArray = npt.NDArray[np.bool_]
_Scalar = TypeVar("_Scalar", bound=np.generic)


def frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    """Make an array read-only and return it, so that values can be shared without copies."""
    array.setflags(write=False)
    return array


def real(values: npt.ArrayLike) -> FloatArray:
    """Copy numbers into an array of doubles; a TypeError, ValueError or OverflowError says why they are none."""
    array = np.array(values)
    if np.iscomplexobj(array):
        raise TypeError("they are complex")
    return array.astype(np.float64, copy=False)
