"""How far off the compressed energy is, from edges whose pairs are summed one by one.

The error is Σ_I δ_I, δ_I that of Σ_J W_IJ over the partners of edge I: its mean over a sample, one edge from each of as
many equal stretches of the curve, estimates it up to a standard error.  The derivative's error along a field u follows
from differences of δ_I between two curves P ± t u: forces on single edges would not help, because their errors, whose
sign depends on the side of its cluster's center that an edge is on, all but cancel, the more so the finer the mesh.
"""

from dataclasses import dataclass

import numpy as np

from ...base.threads import BLAS
from ...base.types import FloatArray, IntArray
from ...curve import Curve
from ..components import ComponentShares, energy_scale
from ..moebius import CONSTANT, MoebiusEnergy, energy_of_pairs
from .energy import HierarchicalMoebiusEnergy

EXACT_UP_TO = 30_000  # vertices; all pairs of edges take some fifteen seconds there


@dataclass(frozen=True)
class Estimate:
    """An estimate of an error, with its sign, from a sample."""

    mean: float  # the expected value
    standard_error: float  # of the mean; 0 where everything has been examined

    @classmethod
    def of_sum(cls, sample: FloatArray, size: int, rest: float = 0.0) -> "Estimate":
        """An estimate of a known number plus a sum of ``size`` numbers, from a sample of these, shape (k,)."""
        k = len(sample)
        spread = float(np.std(sample, ddof=1)) if k < size else 0.0
        return cls(rest + size * float(np.mean(sample)), size * spread * float(np.sqrt((1.0 - k / size) / k)))

    @property
    def bound(self) -> float:
        """A bound of the error's modulus that holds with 95 % probability, two standard errors on either side."""
        return abs(self.mean) + 2.0 * self.standard_error

    def relative(self, scale: float) -> "Estimate":
        return Estimate(self.mean / scale, self.standard_error / scale)


def energy_error(energy: HierarchicalMoebiusEnergy, curve: Curve, count: int = 512) -> Estimate:
    """The error of the energy, from edges of which 512 leave a standard error of some 3e-7, and take half a step."""
    energy, sample = energy.frozen_at(curve), sampled_edges(curve, count)
    rows = energy.row_energies(curve)
    off = rows[sample] - energy.exact.row_energies(curve, sample)
    # the value is not computed from the sums of single edges
    rest = energy.value(curve) - energy_of_pairs(curve, 0.5 * float(rows.sum()))
    return Estimate.of_sum(off, curve.mesh.edges, rest)


def slope_error(energy: HierarchicalMoebiusEnergy, curve: Curve, u: FloatArray, count: int = 128) -> Estimate:
    """The error of the derivative's product with a field u, shape (n, m), from a number of edges of two curves."""
    energy, sample = energy.frozen_at(curve), sampled_edges(curve, count)
    # the largest relative rate at which the distance of two near edges or two clusters can change along u
    blocks = energy.block_list(curve)
    i, j = np.concatenate([blocks.near, blocks.middles], axis=1)
    motion = 0.5 * (u[curve.mesh.tails] + u[curve.mesh.heads])
    speed, distance = (np.linalg.norm(x[i] - x[j], axis=1) for x in (motion, curve.midpoints))
    change = float(np.max(speed / distance, initial=0.0))
    if change == 0.0:
        return Estimate(0.0, 0.0)
    t = 1e-4 / change  # of distances between edges from P to P ± t u, relative
    ends = [curve.with_vertices(curve.vertices + way * u) for way in (t, -t)]
    rows = [energy.row_energies(end) for end in ends]
    off = [each[sample] - energy.exact.row_energies(end, sample) for each, end in zip(rows, ends, strict=True)]
    slope = float(np.sum((energy.value_and_derivative(curve)[1] - CONSTANT * ComponentShares(curve).derivative()) * u))
    rest = slope - float(np.sum(rows[0] - rows[1])) / (2.0 * t)
    return Estimate.of_sum((off[0] - off[1]) / (2.0 * t), curve.mesh.edges, rest)


def sampled_edges(curve: Curve, count: int) -> IntArray:
    """One edge of each of several stretches with equal numbers of edges, at random but always the same; all if few."""
    n = curve.mesh.edges
    if n <= count:
        return np.arange(n)
    ends = np.arange(count + 1) * n // count
    return np.asarray(np.random.default_rng(1).integers(ends[:-1], ends[1:]))


@dataclass(frozen=True)
class SampledErrors:
    """Estimates of the errors of an energy and of a projected gradient from a sample."""

    energy: Estimate  # of the energy E, relative
    gradient_norm: Estimate  # of the norm |u| of the gradient in its metric, relative to it, or to √E if that is larger
    order: int  # of the expansions

    @classmethod
    def at(
        cls, energy: HierarchicalMoebiusEnergy, curve: Curve, value: float, u: FloatArray, norm: float
    ) -> "SampledErrors":
        """Errors of E and of the projected gradient u, (n, m), whose norm an error δ changes by δ·u/|u|."""
        along = slope_error(energy, curve, u).relative(norm) if norm > 0.0 else Estimate(0.0, 0.0)
        scale = energy_scale(curve.mesh, value)
        unit = max(norm, float(np.sqrt(scale)))
        return cls(energy_error(energy, curve).relative(scale), along.relative(unit), energy.order)

    def within(self, accuracy: float) -> bool:
        """Whether both are within it: the energy a hundred times, the norm twice, as the solution's error is added."""
        return self.energy.bound <= 0.01 * accuracy and self.gradient_norm.bound <= 0.5 * accuracy


@BLAS.bounded()
def moebius_energy(curve: Curve) -> tuple[float, float]:
    """The energy and a 95 % bound of its relative error: 0 up to `EXACT_UP_TO` vertices, then by sampled rows."""
    if len(curve) <= EXACT_UP_TO:
        return MoebiusEnergy().value(curve), 0.0
    energy = HierarchicalMoebiusEnergy()
    value = energy.value(curve)
    return value, energy_error(energy, curve).bound / value
