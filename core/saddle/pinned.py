"""Models of inner products on functions that vanish at pins."""

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ..types import FloatArray, IntArray
from .krylov import LinearMap
from .preconditioner import Model


class PinnedModel:
    """The restriction of a model M to functions that vanish at k pins: its inverse, continued by 0 to the pins.

    That is M⁻¹ − M⁻¹E (Eᵀ M⁻¹ E)⁻¹ Eᵀ M⁻¹, E the unit functions of the pins.  Restrictions inherit bounds of
    eigenvalues: M is as good a model as before.

    Parameters
    ----------
    whole
        M, on all n vertices.
    pins
        Indices, shape (k,); it takes k solves with M, and room for k·n numbers.

    Raises
    ------
    numpy.linalg.LinAlgError
        If M is not positive definite.
    """

    def __init__(self, whole: Model, pins: IntArray, n: int) -> None:
        self._whole, self._pins = whole, pins
        units = np.zeros((n, len(pins)))
        units[pins, np.arange(len(pins))] = 1.0
        self._responses = whole.solve(units)
        self._compliance = cho_factor(self._responses[pins], lower=True)

    def solve(self, f: FloatArray) -> FloatArray:
        """The solution with M, and forces at the pins that bring these back; shape (n, k)."""
        u = self._whole.solve(f)
        u = u - self._responses @ cho_solve(self._compliance, u[self._pins])
        u[self._pins] = 0.0  # which it is up to rounding
        return u

    def tension(self, tangents: FloatArray) -> LinearMap:
        """That of M: pins change the Schur complement by a matrix of low rank, for a few iterations more."""
        return self._whole.tension(tangents)


def vanishing_at(pins: IntArray, model: Model, n: int) -> Model:
    """A model on functions on n vertices that vanish at pins, if there are any."""
    return PinnedModel(model, pins, n) if len(pins) else model
