"""Models of inner products on functions that vanish at pins."""

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ..curve import Mesh
from ..curve.pins import holds
from ..types import FloatArray, IntArray
from .krylov import LinearMap
from .preconditioner import Model

DEPTH = 2  # pins that count on either side of those in a row


class PinnedModel:
    """A model M restricted to functions that vanish at pins: its inverse, continued by 0 to the pins.

    That is M⁻¹ − M⁻¹E (Eᵀ M⁻¹ E)⁻¹ Eᵀ M⁻¹, E the unit functions of the pins.  A restriction inherits the bounds of
    eigenvalues.  Of many pins in a row only the first and the last ones count: beyond them hardly anything is left.

    Parameters
    ----------
    whole
        M, on all n vertices.
    pins
        Indices; for k of them that are near free vertices it takes k solves with M, and room for k·n numbers.

    Raises
    ------
    numpy.linalg.LinAlgError
        If M is not positive definite.
    """

    def __init__(self, whole: Model, mesh: Mesh, pins: IntArray) -> None:
        self._whole, self._pins = whole, pins
        self._near = _near_free(mesh, pins)
        units = np.zeros((mesh.size, len(self._near)))
        units[self._near, np.arange(len(self._near))] = 1.0
        self._responses = whole.solve(units)
        self._compliance = cho_factor(self._responses[self._near], lower=True)

    def solve(self, f: FloatArray) -> FloatArray:
        """The solution with M, and forces at the pins that bring these back; shape (n, k)."""
        force = f.copy()
        force[self._pins] = 0.0
        u = self._whole.solve(force)
        u = u - self._responses @ cho_solve(self._compliance, u[self._near])
        u[self._pins] = 0.0
        return np.asarray(u)

    def tension(self, tangents: FloatArray) -> LinearMap:
        """That of M: pins change the Schur complement by a matrix of low rank, for a few iterations more."""
        return self._whole.tension(tangents)


def vanishing_at(pins: IntArray, model: Model, mesh: Mesh) -> Model:
    """A model on functions that vanish at pins, if there are any."""
    return PinnedModel(model, mesh, pins) if len(pins) else model


def _near_free(mesh: Mesh, pins: IntArray) -> IntArray:
    """The pins that are few edges away from a free vertex; all of them if there is none."""
    near = ~holds(mesh, pins)
    if not near.any():
        return pins
    for _ in range(DEPTH):
        ahead, behind = mesh.heads[near[mesh.tails]], mesh.tails[near[mesh.heads]]
        near[ahead] = near[behind] = True
    return np.asarray(pins[near[pins]])
