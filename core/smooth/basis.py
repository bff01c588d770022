"""Real Fourier modes as unknowns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from ..curve.fourier import FourierCurve
from ..types import FloatArray, IntArray


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
