"""Models of inner products on links, and on functions that vanish at pins."""

import numpy as np
import scipy.sparse as sp
from scipy.linalg import cho_factor, cho_solve

from ..curve import Mesh
from ..curve.pins import holds
from ..types import FloatArray, IntArray
from .krylov import Model
from .sparse import factorised

DEPTH = 2  # pins that count on either side of those in a row


class TwoLevel:
    """M⁻¹ = M₀⁻¹ + Z E⁻¹ Zᵀ with E = coupling + V Vᵀ, Z the indicators of the components.

    Components of a link hold each other like masses on springs.  Their graph may be long, such as that of a chain,
    which a model M₀ along the components, ``fine``, does not see; a sparse factorisation of one row a component does.
    ``coupling`` is positive semidefinite, ``vectors`` V have shape (components, r).  A LinAlgError says if E is
    singular.
    """

    def __init__(self, mesh: Mesh, fine: Model, coupling: sp.sparray, vectors: FloatArray) -> None:
        self._fine = fine
        self.tension = fine.tension  # as a whole components have no edge differences
        self._component, self._starts = mesh.component, mesh.offsets[:-1]
        self._rank = vectors.shape[1]
        border = sp.csr_array(vectors)
        # V Vᵀ would be dense
        self._factor = factorised(sp.block_array([[coupling, border], [border.T, -sp.eye_array(self._rank)]]))

    def solve(self, f: FloatArray) -> FloatArray:
        force = np.add.reduceat(f, self._starts, axis=0)
        padded = np.concatenate([force, np.zeros((self._rank, f.shape[1]))])
        shift = self._factor.solve(padded)[: len(force)]
        return np.asarray(self._fine.solve(f) + shift.take(self._component, axis=0))


class PinnedModel:
    """A model M restricted to functions that vanish at pins: its inverse, continued by 0 to the pins.

    That is M⁻¹ − M⁻¹E (Eᵀ M⁻¹ E)⁻¹ Eᵀ M⁻¹, E the unit functions of the pins.  A restriction inherits the bounds of
    eigenvalues.  Of many pins in a row only the first and the last ones count: beyond them hardly anything is left.
    For k pins near free vertices it takes k solves with M, and room for k·n numbers.  A LinAlgError says if M is not
    positive definite.
    """

    def __init__(self, whole: Model, mesh: Mesh, pins: IntArray) -> None:
        self._whole, self._pins = whole, pins
        self.tension = whole.tension  # pins change the Schur complement by a matrix of low rank, for a few iterations
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
