"""Which moments a cluster has, and where they are."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..types import FloatArray
from .polynomials import Polynomials, polynomials


@dataclass(frozen=True)
class Expansion:
    """Taylor expansions of order p about the centre of a cluster: two moments, one below the other in one array.

    With u_I = m_I − centre they are Σ_I ℓ_I exp⟨u_I, ξ⟩ up to degree p and Σ_I ⟨e_I, ξ⟩ exp⟨u_I, ξ⟩ up to degree p + 1.
    Arrays of derivatives with respect to these have rows for those with respect to the centre besides.

    Parameters
    ----------
    dimension
        m, that of space.
    order
        p.
    """

    dimension: int
    order: int

    @property
    def table(self) -> Polynomials:
        """Polynomials of all degrees needed, those of the kernels' derivatives among them."""
        return polynomials(self.dimension, self.order + 3)

    @property
    def lengths(self) -> slice:
        """Rows of the first moment."""
        return slice(0, self.table.size(self.order))

    @property
    def edges(self) -> slice:
        """Rows of the second moment."""
        return slice(self.lengths.stop, self.lengths.stop + self.table.size(self.order + 1))

    @property
    def by_centre(self) -> slice:
        """Rows of derivatives with respect to the centre."""
        return slice(self.edges.stop, self.edges.stop + self.dimension)

    @cached_property
    def signs(self) -> FloatArray:
        """Signs that come with the second cluster of a block, seen from which d is −d; shape (rows,)."""
        signs = self.table.signs[:, 0]
        lengths, edges = signs[: self.table.size(self.order)], -signs[: self.table.size(self.order + 1)]
        return np.concatenate([lengths, edges, np.full(self.dimension, -1.0)])
