"""Models of inner products on links: one of functions along the components, and one of how whole components move.

Components of a link hold each other like masses on springs.  Their graph may be long, such as that of a chain, of which
models along the curve know nothing; a sparse factorisation of one row a component does.
"""

import numpy as np
import scipy.sparse as sp

from ..curve import Mesh
from ..types import FloatArray
from .krylov import LinearMap
from .preconditioner import Model
from .sparse import factorised


class TwoLevel:
    """M⁻¹ = M₀⁻¹ + Z E⁻¹ Zᵀ, Z the indicators of the components.

    Parameters
    ----------
    mesh
        Connectivity.
    fine
        M₀, along the components.
    coupling
        Symmetric positive semidefinite, shape (components, components).
    vectors
        V with E = coupling + V Vᵀ positive definite, shape (components, r).

    Raises
    ------
    numpy.linalg.LinAlgError
        If E is singular.
    """

    def __init__(self, mesh: Mesh, fine: Model, coupling: sp.sparray, vectors: FloatArray) -> None:
        self._fine = fine
        self._component, self._starts = mesh.component, mesh.offsets[:-1]
        self._rank = vectors.shape[1]
        border = sp.csr_array(vectors)
        # V Vᵀ would be dense
        self._factor = factorised(sp.block_array([[coupling, border], [border.T, -sp.eye_array(self._rank)]]))

    def solve(self, f: FloatArray) -> FloatArray:
        """M⁻¹ f; shape (n, k)."""
        force = np.add.reduceat(f, self._starts, axis=0)
        padded = np.concatenate([force, np.zeros((self._rank, f.shape[1]))])
        shift = self._factor.solve(padded)[: len(force)]
        return np.asarray(self._fine.solve(f) + shift[self._component])

    def tension(self, tangents: FloatArray) -> LinearMap:
        """That of the model along the components: as a whole these have no edge differences."""
        return self._fine.tension(tangents)
