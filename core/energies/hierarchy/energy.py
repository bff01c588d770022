"""The Möbius energy in O(N log N): distant clusters by Taylor expansion, near pairs as they are.

The value differs from the sum over all pairs by some 10⁻⁶ of it; the derivative is exactly that of the value.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ...base.arguments import checked_fields, number
from ...base.errors import OptionError
from ...base.types import FloatArray
from ...curve import Curve
from ..components import ComponentShares
from ..edge_pairs import EdgePairIndices
from ..energy import Energy
from ..moebius import CONSTANT, MoebiusEnergy, energy_of_pairs
from ..moebius_pairs import EdgeDerivatives, Edges
from ..quadrature import MIDPOINT
from .blocks import BlockList
from .fields import FarField, NearField

MAX_ORDER = 8  # every two orders make errors some forty times smaller, and half of the work twice as much
KEPT = 1.05  # times θ: separation up to which a list is as good as a new one
OUTDATED = 1.0 / 3.0  # blocks with less separation make a new list; up to 1/3 all replaced pairs are near pairs


@checked_fields
@dataclass(frozen=True, eq=False)
class HierarchicalMoebiusEnergy:
    """The midpoint sum `MoebiusEnergy` for curves of many vertices.

    Every curve has its own block list, and where the list changes the value jumps by its error.  `frozen_at` keeps one,
    which gives a smooth function as long as it fits, as a line search needs.  Where strands are so dense that
    much of the list would be near pairs, it is the midpoint sum itself.

    At order 4 (even orders are better value because the errors of the next odd one nearly cancel), the default θ leaves
    errors below 10⁻⁶ of a knot's energy, and 10⁻⁵ of the derivative in J_C's dual norm.  OptionError if one of the
    numbers is out of range.
    """

    blocks: BlockList | None = None  # used as long as its blocks stay well separated; None for each curve's own
    without: EdgePairIndices | None = None  # near pairs of edges that are left out, because another term replaces them
    order: int = number(4, most=MAX_ORDER)  # of the expansions
    theta: float = number(0.19, most=OUTDATED)  # separation parameter of blocks
    leaf: int = number(16)  # edges up to which clusters are not halved; halving leaves 8 to 16

    name = "moebius"
    rule = MIDPOINT
    scale_exponent = 0.0
    moebius_invariant = True
    contains_midpoint_pairs = True
    description = "Möbius energy without arc distances, midpoint rule, distant clusters by Taylor expansion"

    @classmethod
    def instead_of(cls, energy: Energy) -> "HierarchicalMoebiusEnergy":
        """The fast form of an energy; OptionError unless it is the default one, the only one with a fast form."""
        if not isinstance(energy, MoebiusEnergy):
            raise OptionError(
                f"energy {energy.name!r} has no fast form for so many vertices; choose 'moebius' or fewer vertices"
            )
        return cls(without=energy.without)

    def frozen_at(self, curve: Curve) -> "HierarchicalMoebiusEnergy":
        """The smooth function given by the block list of ``curve``, or by this energy's own list if it fits."""
        if self.blocks is not None and self.blocks.is_separated(curve, KEPT * self.theta):
            return self
        return replace(self, blocks=_block_list(curve, self.theta, self.leaf))

    def leaving_out(self, pairs: EdgePairIndices) -> "HierarchicalMoebiusEnergy":
        """The same sum without some near pairs of edges, such as `replaced_pairs`."""
        return replace(self, without=pairs)

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
            return self.exact.value(curve)
        near, far = self._fields(blocks, _unit_sized(curve)[0])
        return energy_of_pairs(curve, near.value() + far.value())

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        blocks = self.block_list(curve)
        if blocks.mostly_near:
            return self.exact.value_and_derivative(curve)
        unit, exponent = _unit_sized(curve)
        value, sums, edges = self._value_and_sums(blocks, unit)
        derivative = 2.0 * sums.at_vertices(curve.mesh, edges.tau) + CONSTANT * ComponentShares(unit).derivative()
        return energy_of_pairs(curve, value), np.ldexp(derivative, -exponent)

    def hessian(self, curve: Curve) -> FloatArray:
        return self.exact.hessian(curve)

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

    def row_energies(self, curve: Curve) -> FloatArray:
        blocks = self.block_list(curve)
        if blocks.mostly_near:
            return self.exact.row_energies(curve, np.arange(curve.mesh.edges))
        _, sums, edges = self._value_and_sums(blocks, _unit_sized(curve)[0])
        return sums.row_energies(edges)

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
