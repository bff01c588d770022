"""The Möbius energy of smooth links without arc length, with its first and second derivatives.

For one closed curve it is 4 + ∬ (1 − cos α)/|x − y|² dx dy, where α is the angle between the circles through x and y
that are tangent to the curve at x and at y (Doyle and Schramm; see O'Hara, *Energy of Knots and Conformal Geometry*,
2003).  The integrand is smooth, also on the diagonal, where it is 0.  Two components have 2 ∬ 1/|x − y|² dx dy.
Integrands of analytic curves are analytic and periodic, so that the trapezoidal rule converges geometrically.

With r = y − x and velocities v at x, w at y the integrand is f = (|v||w| + s⟨v, w⟩) u − 2s ⟨v, r⟩⟨w, r⟩ u², u = 1/|r|²,
where s is 1 on one component and 0 between two.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..types import FloatArray
from .basis import Basis

Block = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""∂²f by (r, r), (r, v), (r, w), (v, v) and (v, w), of one coordinate each; shape (n, n)."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """What f is made of, at all pairs (x, y) of sampled points; shapes (n, n), but for vectors."""

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
    def of(cls, basis: Basis, z: FloatArray) -> "Pairs":
        """Those of the curve with unknowns z."""
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
        f = self.u * (self.g - 2.0 * self.p * self.q * self.u)
        return 4.0 * len(self.basis.modes) + float(np.sum(self.weights * f))

    @property
    def gradient(self) -> FloatArray:
        """By the unknowns; shape (N, 3).  Each point is x of as many pairs as it is y of, with the same f."""
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
        """By the unknowns, coordinate by coordinate within each; shape (3N, 3N)."""
        B, D = self.basis.values, self.basis.slopes
        count, twice = len(self.basis.scale), 2.0 * self.weights
        here = np.arange(len(B))
        hessian = np.zeros((count, 3, count, 3))
        for k, m, (rr, rv, rw, vv, vw) in self._blocks():
            xx, xv, by_v = -twice * rr, -twice * rw, twice * vw
            xx[here, here] = -xx.sum(axis=1)
            xv[here, here] = -(twice * rv).sum(axis=1)
            by_v[here, here] = (twice * vv).sum(axis=1)
            mixed = B.T @ xv @ D
            hessian[:, k, :, m] += B.T @ xx @ B + D.T @ by_v @ D + mixed
            hessian[:, m, :, k] += mixed.T
        return hessian.reshape(3 * count, 3 * count)

    @property
    def _along_r(self) -> FloatArray:
        """What r itself is multiplied by in ∂f/∂r."""
        return np.asarray(8.0 * self.p * self.q * self.u**3 - 2.0 * self.g * self.u**2)

    def _blocks(self) -> Iterator[tuple[int, int, Block]]:
        """The second derivatives of f for each pair of coordinates."""
        u, p, q, g, s, speeds = self.u, self.p, self.q, self.g, self.same, self.speeds
        along, su2 = self._along_r, self.same * u**2
        ratio, product = speeds / speeds[:, None], np.outer(speeds, speeds)
        double = 8.0 * g * u**3 - 48.0 * p * q * u**4
        for k in range(3):
            for m in range(3):
                rk, rm, rkm, same = self.r[k], self.r[m], self.r[k] * self.r[m], float(k == m)
                wk, wm = self.velocities[:, k], self.velocities[:, m]
                vk, vm = wk[:, None], wm[:, None]
                tk, tm = q * vk + p * wk, q * vm + p * wm
                rr = same * along + double * rkm - 2.0 * su2 * (vk * wm + wk * vm) + 8.0 * u**3 * (tk * rm + rk * tm)
                by_v, by_w = ratio * vm + s * wm, wm / ratio + s * vm
                rv = 8.0 * u**3 * q * rkm - 2.0 * u**2 * (rk * by_v + same * q) - 2.0 * su2 * wk * rm
                rw = 8.0 * u**3 * p * rkm - 2.0 * u**2 * (rk * by_w + same * p) - 2.0 * su2 * vk * rm
                vv = u * ratio * (same - vk * vm / speeds[:, None] ** 2)
                vw = u * (vk * wm / product + s * same) - 2.0 * su2 * rkm
                yield k, m, (rr, rv, rw, vv, vw)
