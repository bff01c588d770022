"""Bending as a term of the objective: what makes a relaxed curve rounder than its energy alone would."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..curve import Curve
from ..curve.measures import bending, bending_and_derivative
from ..types import FloatArray


@dataclass(frozen=True)
class Bending:
    """L ∫ κ² ds, 4π² on a round circle; see `core.curve.measures`."""

    name = "bending"
    description = "L ∫ κ² ds, 4π² on a round circle"
    scale_exponent = 0.0

    def value(self, curve: Curve) -> float:
        """The bending of the curve."""
        return bending(curve)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The bending and its derivative with respect to the vertices, shape (n, m)."""
        return bending_and_derivative(curve)

    def stiffness(self, curve: Curve) -> sp.csr_array:
        """2 L Σ |Δu₊/ℓ₊ − Δu₋/ℓ₋|²/ℓ̄, the second derivative on a nearly straight curve; shape (n, n)."""
        mesh, ell, edges = curve.mesh, curve.edge_lengths, np.arange(curve.mesh.edges)
        slope = sp.csr_array((1.0 / ell, (edges, mesh.heads)), shape=(mesh.edges, mesh.size))
        slope -= sp.csr_array((1.0 / ell, (edges, mesh.tails)), shape=(mesh.edges, mesh.size))
        before, after = mesh.incoming[mesh.inner], mesh.outgoing[mesh.inner]
        turn = slope[after] - slope[before]
        return sp.csr_array(turn.T @ sp.diags_array(4.0 * curve.length / (ell[before] + ell[after])) @ turn)
