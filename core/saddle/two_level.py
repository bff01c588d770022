"""A model of inner products on links: circulants on the components, and the motion of whole components exactly.

Components of a link hold each other like masses on springs.  Their graph may be long, such as that of a chain, and
circulants know nothing of it; a sparse factorisation of one row a component does.
"""

import numpy as np
import scipy.sparse as sp

from ..curve import Mesh
from ..types import FloatArray
from .circulant import Circulants
from .sparse import factorised


class TwoLevel:
    """M⁻¹ = circulants + Z E⁻¹ Zᵀ, Z the indicators of the components.

    Parameters
    ----------
    mesh
        Connectivity.
    circulants
        The fine level.
    coupling
        Symmetric positive semidefinite, shape (components, components).
    vectors
        V with E = coupling + V Vᵀ positive definite, shape (components, r).

    Raises
    ------
    numpy.linalg.LinAlgError
        If E is singular.
    """

    def __init__(self, mesh: Mesh, circulants: Circulants, coupling: sp.sparray, vectors: FloatArray) -> None:
        self._circulants = circulants
        self._component, self._starts = mesh.component, mesh.offsets[:-1]
        rank = vectors.shape[1]
        border = sp.csr_array(vectors)
        # V Vᵀ would be dense
        self._factor = factorised(sp.block_array([[coupling, border], [border.T, -sp.eye_array(rank)]]))
        self._no_force = np.zeros((rank, 1))

    def solve(self, f: FloatArray) -> FloatArray:
        """M⁻¹ f; shape (n, k)."""
        force = np.add.reduceat(f, self._starts, axis=0)
        padded = np.concatenate([force, np.repeat(self._no_force, f.shape[1], axis=1)])
        shift = self._factor.solve(padded)[: len(force)]
        return np.asarray(self._circulants.solve(f) + shift[self._component])

    def solve_differences(self, g: FloatArray) -> FloatArray:
        """(D M⁻¹ Dᵀ)⁻¹ g, approximately: whole components have no edge differences; shape (n, k)."""
        return self._circulants.solve_differences(g)
