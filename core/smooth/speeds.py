"""How fast smooth curves run through their strands: energies do not depend on it, but the number of modes does."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..curve import Curve
from ..energies.moebius import moebius_by_length
from ..types import FloatArray
from .fourier import Basis, periodic

_LEAST = 4.0  # energy that is spread over each component by length: that of a circle, which pairs do not have


@dataclass(frozen=True, eq=False)
class Pace:
    """Speeds in inverse proportion to the density of energy, which is about π/d beside a strand at distance d.

    As the density of the Möbius energy is Möbius-invariant, so is this parametrisation.
    """

    at: Sequence[FloatArray]  # parameters of a polygon's vertices, for each component from 0 to below 1
    logarithms: Sequence[CubicSpline]  # of the speeds, by the parameters

    @classmethod
    def of(cls, curve: Curve) -> "Pace":
        """That of a closed polygon."""
        densities, edges = (
            np.split(each, curve.mesh.offsets[1:-1]) for each in (moebius_by_length(curve), curve.edge_lengths)
        )
        at, logarithms = [], []
        for density, ell in zip(densities, edges, strict=True):
            density = density + _LEAST / ell.sum()
            run = np.cumsum(ell * density)
            at.append(np.append(0.0, run[:-1] / run[-1]))
            logarithms.append(periodic(at[-1], -np.log(0.5 * (density + np.roll(density, 1)))))
        return cls(at, logarithms)

    def speeds(self, basis: Basis, z: FloatArray) -> "Speeds":
        """How far the curve of unknowns z keeps to it."""
        wanted = np.concatenate([log(basis.t[basis.component == k]) for k, log in enumerate(self.logarithms)])
        velocities = basis.slopes @ z
        squares = np.sum(velocities**2, axis=1)
        excess = 0.5 * np.log(squares) - wanted
        return Speeds(basis, velocities, squares, excess - basis.averages(excess))


@dataclass(frozen=True, eq=False)
class Speeds:
    """∫ (log |γ′| − log of the wanted speed)² of each component, but for a factor of all its speeds."""

    basis: Basis
    velocities: FloatArray  # shape (n, 3)
    squares: FloatArray  # |γ′|²; shape (n,)
    excess: FloatArray  # of log |γ′| over what is wanted and its component's average; shape (n,)

    @property
    def energy(self) -> float:
        return float(np.sum(self.basis.weights * self.excess**2))

    @property
    def gradient(self) -> FloatArray:
        """By the unknowns; shape (N, 3)."""
        factors = 2.0 * self.basis.weights * self.excess / self.squares
        return np.asarray(self.basis.slopes.T @ (factors[:, None] * self.velocities))

    @property
    def hessian(self) -> FloatArray:
        """Gauss and Newton's, which is exact where speeds are as wanted; shape (3N, 3N)."""
        rows = np.einsum("ik,in->ink", self.velocities / self.squares[:, None], self.basis.slopes)
        rows = (rows - self.basis.averages(rows)).reshape(len(rows), -1)
        return np.asarray(2.0 * (rows.T * self.basis.weights) @ rows)
