"""The Möbius energy of smooth links without arc length, with its first and second derivatives by real Fourier modes.

For one closed curve it is 4 + ∬ (1 − cos α)/|x − y|² dx dy, where α is the angle between the circles through x and y
that are tangent to the curve at x and at y (Doyle and Schramm; see O'Hara, *Energy of Knots and Conformal Geometry*,
2003).  The integrand is smooth, also on the diagonal, where it is 0.  Two components have 2 ∬ 1/|x − y|² dx dy.
Integrands of analytic curves are analytic and periodic, so that the trapezoidal rule converges geometrically.  Energies
do not depend on how fast curves run along their strands, but the number of modes does.

With r = y − x and velocities v at x, w at y the integrand is f = (|v||w| + s⟨v, w⟩) u − 2s ⟨v, r⟩⟨w, r⟩ u², u = 1/|r|²,
where s is 1 on one component and 0 between two.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from scipy.linalg import block_diag

from ...core.base.types import FloatArray, IntArray
from ...core.curve import Curve
from ...core.energies.moebius import moebius_by_length
from ...core.knots.shapes import SmoothShape
from .fourier import FourierCurve


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

    def unknowns(self, curve: SmoothShape) -> FloatArray:
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


@dataclass(frozen=True, eq=False)
class SampledPairs:
    """The ingredients of f at all pairs (x, y) of sampled points; shapes (n, n), except for vectors."""

    basis: Basis
    velocities: FloatArray  # shape (n, 3)
    speeds: FloatArray  # shape (n,)
    r: FloatArray  # y − x; shape (3, n, n)
    u: FloatArray
    p: FloatArray  # s⟨v, r⟩
    q: FloatArray  # s⟨w, r⟩
    g: FloatArray  # |v||w| + s⟨v, w⟩
    same: FloatArray  # s
    weights: FloatArray  # of pairs, 0 on the diagonal

    @classmethod
    def of(cls, basis: Basis, z: FloatArray) -> "SampledPairs":
        """The pairs of the curve with unknowns z."""
        x, v = basis.values @ z, basis.slopes @ z
        same = np.equal.outer(basis.component, basis.component).astype(np.float64)
        weights = np.outer(basis.weights, basis.weights)
        np.fill_diagonal(weights, 0.0)
        r = x.T[:, None, :] - x.T[:, :, None]
        square = np.einsum("kij,kij->ij", r, r)
        np.fill_diagonal(square, 1.0)
        p, q = np.einsum("ik,kij->ij", v, r), np.einsum("jk,kij->ij", v, r)
        speeds = np.linalg.norm(v, axis=1)
        g = np.outer(speeds, speeds) + same * (v @ v.T)
        return cls(basis, v, speeds, r, 1.0 / square, same * p, same * q, g, same, weights)

    @property
    def energy(self) -> float:
        """4 for each component, and Σ f."""
        return 4.0 * len(self.basis.modes) + float(np.sum(self.shares))

    @property
    def shares(self) -> FloatArray:
        """The share of each pair in Σ f, which no Möbius map changes; shape (n, n)."""
        return np.asarray(self.weights * self.u * (self.g - 2.0 * self.p * self.q * self.u))

    @property
    def gradient(self) -> FloatArray:
        """The derivative by the unknowns; shape (N, 3).  Each point is x in as many pairs as y, with the same f."""
        v, r, u = self.velocities, self.r, self.u
        twice = 2.0 * self.weights
        along = twice * self._along_r
        by_x = np.empty_like(v)
        by_v = np.sum(twice * u * (self.speeds / self.speeds[:, None]), axis=1)[:, None] * v
        by_v += (twice * u * self.same) @ v
        for k in range(3):
            tangential = self.q * v[:, k, None] + self.p * v[:, k]
            by_x[:, k] = np.sum(2.0 * twice * u**2 * tangential - along * r[k], axis=1)
            by_v[:, k] -= np.sum(2.0 * twice * self.q * u**2 * r[k], axis=1)
        return np.asarray(self.basis.values.T @ by_x + self.basis.slopes.T @ by_v)

    @property
    def hessian(self) -> FloatArray:
        """Second derivatives by the unknowns, coordinate by coordinate within each; shape (3N, 3N)."""
        B, D, count = self.basis.values, self.basis.slopes, len(self.basis.scale)
        hessian = np.empty((count, 3, count, 3))
        mixed = [[B.T @ block @ D for block in row] for row in self._by_x_and_v()]
        for k, m, by_x, by_v in self._blocks():
            block = B.T @ by_x @ B + D.T @ by_v @ D + mixed[k][m] + mixed[m][k].T
            hessian[:, k, :, m], hessian[:, m, :, k] = block, block.T
        return hessian.reshape(3 * count, 3 * count)

    @property
    def _along_r(self) -> FloatArray:
        """The factor of r itself in ∂f/∂r."""
        return np.asarray(8.0 * self.p * self.q * self.u**3 - 2.0 * self.g * self.u**2)

    def _blocks(self) -> Iterator[tuple[int, int, FloatArray, FloatArray]]:
        """Second derivatives of Σ f by two points, and by two velocities, for coordinates k ≤ m; shape (n, n)."""
        twice, u, p, q, g, speeds = 2.0 * self.weights, self.u, self.p, self.q, self.g, self.speeds
        along, cubic, su2 = self._along_r, 8.0 * u**3, self.same * u**2
        double = g * cubic - 48.0 * p * q * u**4
        by_speeds, by_product = twice * u * speeds / speeds[:, None], u / np.outer(speeds, speeds)
        for k, m in combinations_with_replacement(range(3), 2):
            rk, rm, v, w, same = self.r[k], self.r[m], self.velocities[:, k], self.velocities[:, m], float(k == m)
            tk, tm = q * v[:, None] + p * v, q * w[:, None] + p * w
            vw = np.outer(v, w)
            rr = same * along + double * (rk * rm) - 2.0 * su2 * (vw + vw.T) + cubic * (tk * rm + rk * tm)
            by_x = -twice * rr
            np.fill_diagonal(by_x, -by_x.sum(axis=1))
            by_v = twice * (by_product * vw + same * self.same * u - 2.0 * su2 * (rk * rm))
            np.fill_diagonal(by_v, by_speeds.sum(axis=1) * (same - v * w / speeds**2))
            yield k, m, by_x, by_v

    def _by_x_and_v(self) -> Iterator[list[FloatArray]]:
        """Mixed derivatives by coordinate k of a point and m of a velocity, row by row; f(y, x) is f(x, y)."""
        twice, u, s, ratio = 2.0 * self.weights, self.u, self.same, self.speeds / self.speeds[:, None]
        cubic, quadratic, q = 8.0 * twice * u**3 * self.q, -2.0 * twice * u**2, self.q
        for k in range(3):
            row, rk, v = [], self.r[k], self.velocities[:, k]
            for m in range(3):
                w = self.velocities[:, m]
                by_v = ratio * w[:, None] + s * w
                rv = cubic * (rk * self.r[m]) + quadratic * (rk * by_v + float(k == m) * s * q + s * v * self.r[m])
                np.fill_diagonal(rv, -rv.sum(axis=1))
                row.append(rv.T)
            yield row
