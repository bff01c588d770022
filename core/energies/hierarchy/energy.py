"""The Möbius energy in O(N log N): distant clusters by Taylor expansion, near pairs as they are; and how far off it is.

The value differs from the sum over all pairs by some 10⁻⁶ of it; the derivative is exactly that of the value.

Its error is estimated from edges whose pairs are summed one by one: it is Σ_I δ_I, δ_I that of Σ_J W_IJ over the
partners of edge I.  Its mean over a sample, one edge from each of as many equal stretches of the curve, estimates it up
to a standard error.  The derivative's error along a field u follows from differences of δ_I between two curves P ± t u:
forces on single edges would not help, because their errors, whose sign depends on the side of its cluster's center that
an edge is on, all but cancel, the more so the finer the mesh.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...base import BLAS, FloatArray, IntArray, checked_fields, number
from ...curve import Curve
from ..components import CONSTANT, ComponentShares, energy_of_pairs, energy_scale
from ..moebius import EdgeDerivatives, Edges, MoebiusEnergy
from .blocks import BlockList
from .fields import FarField, NearField

MAX_ORDER = 8  # every two orders make errors some forty times smaller, and half of the work twice as much
KEPT = 1.05  # times θ: separation up to which a list is as good as a new one
OUTDATED = 1.0 / 3.0  # blocks with less separation make a new list; up to 1/3 all replaced pairs are near pairs
EXACT_UP_TO = 30_000  # vertices; all pairs of edges take some fifteen seconds there


@checked_fields
@dataclass(frozen=True, eq=False)
class HierarchicalMoebiusEnergy(MoebiusEnergy):
    """The midpoint sum for curves of many vertices; its second derivative as a matrix is that of the sum itself.

    Every curve has its own block list, and where the list changes the value jumps by its error.  `frozen_at` keeps one,
    which gives a smooth function as long as it fits, as a line search needs.  Where strands are so dense that
    much of the list would be near pairs, it is the midpoint sum itself.

    At order 4 (even orders are better value because the errors of the next odd one nearly cancel), the default θ leaves
    errors below 10⁻⁶ of a knot's energy, and 10⁻⁵ of the derivative in J_C's dual norm.  OptionError if one of the
    numbers is out of range.
    """

    blocks: BlockList | None = None  # used as long as its blocks stay well separated; None for each curve's own
    order: int = number(4, most=MAX_ORDER)  # of the expansions
    theta: float = number(0.19, most=OUTDATED)  # separation parameter of blocks
    leaf: int = number(16)  # edges up to which clusters are not halved; halving leaves 8 to 16

    description = "Möbius energy without arc distances, midpoint rule, distant clusters by Taylor expansion"

    def frozen_at(self, curve: Curve) -> "HierarchicalMoebiusEnergy":
        """The smooth function given by the block list of ``curve``, or by this energy's own list if it fits."""
        if self.blocks is not None and self.blocks.is_separated(curve, KEPT * self.theta):
            return self
        return replace(self, blocks=_block_list(curve, self.theta, self.leaf))

    @property
    def exact(self) -> MoebiusEnergy:
        """The sum that this one approximates, pair by pair."""
        return MoebiusEnergy(self.without)

    @property
    def tightened(self) -> "HierarchicalMoebiusEnergy | None":
        """The same with expansions two orders higher; None if there are none."""
        return replace(self, order=self.order + 2) if self.order < MAX_ORDER else None

    def value(self, curve: Curve) -> float:
        blocks = self.block_list(curve)
        if blocks.mostly_near:
            return super().value(curve)
        near, far = self._fields(blocks, _unit_sized(curve)[0])
        return energy_of_pairs(curve, near.value() + far.value())

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        blocks = self.block_list(curve)
        if blocks.mostly_near:
            return super().value_and_derivative(curve)
        unit, exponent = _unit_sized(curve)
        value, sums, edges = self._value_and_sums(blocks, unit)
        derivative = 2.0 * sums.at_vertices(curve.mesh, edges.tau) + CONSTANT * ComponentShares(unit).derivative()
        return energy_of_pairs(curve, value), np.ldexp(derivative, -exponent)

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """D²E v for ``v`` of shape (n, m), to some five digits: a central difference with one block list."""
        smooth, ell = self.frozen_at(curve), curve.edge_lengths
        # no edge is stretched by more than 1e-4 of it, and no vertex moves by more than 1e-2 of the shortest one
        stretch = np.abs(curve.mesh.changes(v) / ell[:, None]).max() / 1e-4
        rate = max(float(stretch), float(np.abs(v).max() / (1e-2 * ell.min())))
        if rate == 0.0:
            return np.zeros_like(v)
        ends = (curve.with_vertices(curve.vertices + sign * v / rate) for sign in (1.0, -1.0))
        ahead, behind = (smooth.value_and_derivative(end)[1] for end in ends)
        return 0.5 * rate * (ahead - behind)

    def row_energies(self, curve: Curve, rows: IntArray) -> FloatArray:
        blocks = self.block_list(curve)
        if blocks.mostly_near:
            return super().row_energies(curve, rows)
        _, sums, edges = self._value_and_sums(blocks, _unit_sized(curve)[0])
        return sums.row_energies(edges)[rows]

    def _fields(self, blocks: BlockList, unit: Curve) -> tuple[NearField, FarField]:
        edges = Edges.of(unit)
        return NearField(edges, blocks.near_pairs(self.without)), FarField(blocks, edges, self.order)

    def _value_and_sums(self, blocks: BlockList, unit: Curve) -> tuple[float, EdgeDerivatives, Edges]:
        near, far = self._fields(blocks, unit)
        value, sums = near.value_and_derivative()
        more, further = far.value_and_derivative()
        for part, other in zip(sums, further, strict=True):
            part += other
        return value + more, sums, near.edges

    def block_list(self, curve: Curve) -> BlockList:
        """The list in use at a curve: this energy's own, or the curve's."""
        if self.blocks is not None and self.blocks.is_separated(curve, OUTDATED):
            return self.blocks
        return _block_list(curve, self.theta, self.leaf)


@lru_cache(maxsize=1)
def _block_list(curve: Curve, theta: float, leaf: int) -> BlockList:
    """The list of a curve; the last one is kept, for value and derivative alike."""
    return BlockList.of(curve, theta, leaf)


def _unit_sized(curve: Curve) -> tuple[Curve, int]:
    """The curve divided by a power of two, so that its size is about 1 whatever its units, and the exponent."""
    exponent = int(np.frexp(np.ptp(curve.vertices, axis=0).max())[1])
    return curve.with_vertices(np.ldexp(curve.vertices, -exponent)), exponent


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
    rows = energy.row_energies(curve, np.arange(curve.mesh.edges))
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
    rows = [energy.row_energies(end, np.arange(curve.mesh.edges)) for end in ends]
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
