"""Real Fourier modes as unknowns, and how fast curves run along their strands.

Energies do not depend on that pace, but the number of modes does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from ...core.base.types import FloatArray, IntArray
from ...core.curve import Curve
from ...core.curve.fourier import FourierCurve
from ...core.energies.moebius import moebius_by_length


@dataclass(frozen=True, eq=False)
class Basis:
    """Real Fourier modes of all components, sampled at n equal steps, for unknowns z with N rows, shape (N, 3).

    The mode of frequency k is divided by k^{3/2}, which makes the energy's Hessian an operator of order 0.
    """

    modes: tuple[int, ...]
    scale: FloatArray  # k^{-3/2}, or 1 for k = 0; shape (N,)
    values: FloatArray  # points are ``values @ z``; shape (n, N)
    slopes: FloatArray  # their derivatives by t are ``slopes @ z``; shape (n, N)
    component: IntArray  # of each point; shape (n,)
    weights: FloatArray  # of the trapezoidal rule, 1 in all for a component; shape (n,)

    @classmethod
    def of(cls, modes: Sequence[int], per_mode: int) -> "Basis":
        """The basis for curves with some modes, with ``per_mode`` points for each mode."""
        values, slopes, scales = [], [], []
        for most in modes:
            k = np.concatenate([np.arange(most + 1), np.arange(1, most + 1)])
            turned = np.arange(len(k)) > most  # −sin 2πkt, for the imaginary parts
            angles = 2.0 * np.pi * np.outer(np.arange(per_mode * most) / (per_mode * most), k)
            scales.append(np.maximum(k, 1.0) ** -1.5)
            values.append(np.where(turned, -np.sin(angles), np.cos(angles)) * scales[-1])
            slopes.append(np.where(turned, -np.cos(angles), -np.sin(angles)) * (2.0 * np.pi * k * scales[-1]))
        counts = [per_mode * most for most in modes]
        component, weights = np.repeat(np.arange(len(counts)), counts), 1.0 / np.repeat(counts, counts)
        return cls(tuple(modes), np.concatenate(scales), block_diag(*values), block_diag(*slopes), component, weights)

    def unknowns(self, curve: FourierCurve) -> FloatArray:
        """The unknowns of a curve with these modes; shape (N, 3)."""
        parts = [part for c in curve.coefficients for part in (c.real, c.imag[1:])]
        return np.asarray(np.concatenate(parts) / self.scale[:, None])

    def unknowns_of(self, samples: FloatArray) -> FloatArray:
        """The unknowns, shape (N, 3), of samples, shape (n, 3), or of the nearest samples that have any."""
        weighted = self.values.T * self.weights
        return np.asarray(weighted @ samples / np.einsum("in,ni->i", weighted, self.values)[:, None])

    def curve(self, z: FloatArray) -> FourierCurve:
        """The curve of unknowns z."""
        rows, parts = self.scale[:, None] * z, []
        for k in self.modes:
            imaginary = np.concatenate([np.zeros((1, 3)), rows[k + 1 : 2 * k + 1]])
            parts.append(rows[: k + 1] + 1j * imaginary)
            rows = rows[2 * k + 1 :]
        return FourierCurve(tuple(parts))

    def averages(self, samples: FloatArray) -> FloatArray:
        """At each point its component's average of samples, shape (n, …)."""
        means = [samples[self.component == k].mean(axis=0) for k in range(len(self.modes))]
        return np.asarray(np.stack(means)[self.component])


def parameters(curve: Curve) -> list[FloatArray]:
    """Parameters of a closed polygon's vertices that grow with the energy, for each component from 0 to below 1.

    They make curves slow where strands are near: the density of energy beside a strand at distance d is about π/d, and
    that density is Möbius-invariant.
    """
    cuts, found = curve.mesh.offsets[1:-1], []
    for density, ell in zip(np.split(moebius_by_length(curve), cuts), np.split(curve.edge_lengths, cuts), strict=True):
        # 4.0: energy of a circle, which no pairs account for: it is spread over each component by length
        passed = np.cumsum(ell * density + 4.0 * ell / ell.sum())
        found.append(np.append(0.0, passed[:-1] / passed[-1]))
    return found


def sliding(basis: Basis, z: FloatArray) -> FloatArray:
    """The quadratic form ∫ (d log |γ′| − its average)² of each component, at unknowns z; shape (3N, 3N).

    Added to the energy's Hessian it keeps points from sliding along the curve, which nothing else does.
    """
    v = basis.slopes @ z
    rows = np.einsum("ik,in->ink", v / np.sum(v**2, axis=1, keepdims=True), basis.slopes)
    rows = (rows - basis.averages(rows)).reshape(len(rows), -1)
    return np.asarray((rows.T * basis.weights) @ rows)
