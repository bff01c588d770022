"""The constraints Φ of Section 6.1.3 of [RS21]: prescribed edge lengths, and blocks of further rows; and pins.

Φ = (log ℓ_I − log ℓ⁰_I)_I followed by the rows of each block, such as a fixed barycenter.  Lengths enter as logarithms,
so one tolerance means the same relative error on every edge; solvers of (41) eliminate them by their structure.  Blocks
have few rows, which border the rest.

A pinned vertex is no unknown: P_v = P⁰_v holds exactly, not as rows of Φ.  It takes the place of its part's barycenter,
and the length of an edge between two pins, which cannot change, is no row either: so DΦ has full rank on what is free.

Under a symmetry all vertices of an orbit are one unknown: images are put where they belong, as pins are.  Φ keeps its
rows, whose solutions are symmetric where the curve is.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import Protocol, TypeVar

import numpy as np
import scipy.sparse as sp

from ...base.types import FloatArray, IntArray
from ...curve import NO_PINS, NOWHERE, Curve, Mesh, Pins, free_edges
from ...curve.symmetry import NO_SYMMETRY, Symmetry
from .barycenters import Barycenters, Parts

_Block = TypeVar("_Block", bound="Block")


class Block(Protocol):
    """A few rows of Φ, functions of vertices and edge lengths; it refers to no particular mesh of the curve."""

    @property
    def rows(self) -> int:
        """Their number k."""

    def residual(self, curve: Curve) -> FloatArray:
        """Their values, shape (k,); 0 where the constraint holds."""

    def derivative(self, curve: Curve) -> "BlockDerivative":
        """Their derivative at a curve."""

    def error(self, lengths: FloatArray, mesh: Mesh, residual: FloatArray) -> float:
        """What a residual means as one number, comparable to relative errors of the target lengths, shape (edges,)."""

    def corrected(self, curve: Curve, u: FloatArray, stretch: FloatArray, residual: FloatArray) -> FloatArray | None:
        """Displacements u with what reaches the targets of these rows too and changes no length; shape (n, m).

        ``stretch``, shape (edges,), is by how much u changes lengths.  None if there is no cheap way: then corrections
        towards all constraints are the shortest ones in the metric.
        """

    def on(self, curve: Curve) -> "Block":
        """The same for a curve of another place, shape, mesh or units, with the targets that it has there."""

    def scaled(self, factor: float) -> "Block":
        """With the targets of the curve scaled by a factor."""


class BlockDerivative(Protocol):
    """The derivative of k rows, as functions of vertices P and of the logarithms s of edge lengths."""

    @property
    def rows(self) -> int:
        """k."""

    def apply(self, u: FloatArray, stretch: FloatArray) -> FloatArray:
        """∂_P Φ u + ∂_s Φ stretch for displacements u, shape (n, m), and the ds that they cause; shape (k,)."""

    def loads(self, multipliers: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(∂_s Φᵀ λ, ∂_P Φᵀ λ), tensions of edges, shape (edges,), and forces on vertices, shape (n, m)."""

    def curvature(self, multipliers: FloatArray, v: FloatArray) -> FloatArray:
        """Σ λ_k ∂²_P Φ_k v for displacements v that keep the lengths; shape (n, m)."""


BLOCKS: tuple[Callable[[Curve, Pins], Block], ...] = (Barycenters.of,)
"""What makes the blocks of a relaxation from its start."""


@dataclass(frozen=True, eq=False)
class Constraints:
    """Targets of the constraints."""

    lengths: FloatArray  # target lengths ℓ⁰, positive, shape (edges,)
    blocks: tuple[Block, ...]  # the rows after those of the lengths
    pins: Pins = NO_PINS  # vertices that stay where they are
    symmetry: Symmetry = NO_SYMMETRY  # which all displacements have
    grown: float = 1.0  # how many times as long the targets are as they were at first, but for edges between two pins

    @classmethod
    def of(cls, curve: Curve, pins: Pins = NO_PINS, blocks: Sequence[Block] | None = None) -> "Constraints":
        """Those that a curve satisfies, with the usual blocks or some others."""
        own = [make(curve, pins) for make in BLOCKS] if blocks is None else [block.on(curve) for block in blocks]
        return cls(curve.edge_lengths, tuple(own), pins)

    def block(self, kind: type[_Block]) -> _Block:
        return next(block for block in self.blocks if isinstance(block, kind))

    def replacing(self, block: Block) -> "Constraints":
        """With another block in place of the one of its kind."""
        return replace(self, blocks=tuple(block if type(own) is type(block) else own for own in self.blocks))

    def scaled(self, factor: float, mesh: Mesh) -> "Constraints":
        """All lengths times a factor, but for edges between two pins, and the blocks to match."""
        lengths, free = self.lengths.copy(), free_edges(mesh, self.pins.vertices)
        lengths[free] *= factor
        blocks = tuple(block.scaled(factor) for block in self.blocks)
        return replace(self, lengths=lengths, blocks=blocks, grown=factor * self.grown)

    def derivative(self, curve: Curve) -> "ConstraintDerivative":
        blocks = tuple(block.derivative(curve) for block in self.blocks)
        edges = free_edges(curve.mesh, self.pins.vertices)
        return replace(ConstraintDerivative.of(curve, self.pins.vertices, edges, blocks), symmetry=self.symmetry)

    def residual(self, curve: Curve) -> FloatArray:
        """Φ(P): the logarithmic errors of r lengths, then the k rows of blocks; shape (r + k,)."""
        stretch = np.log(curve.edge_lengths / self.lengths)
        rows = [block.residual(curve) for block in self.blocks]
        return np.concatenate([stretch[free_edges(curve.mesh, self.pins.vertices)], *rows])

    def error(self, mesh: Mesh, residual: FloatArray) -> float:
        """The largest relative error of a length, or what blocks compare to it, that a residual means."""
        rows = len(free_edges(mesh, self.pins.vertices))
        worst = float(np.max(np.abs(residual[:rows]), initial=0.0))
        return max([worst, *(block.error(self.lengths, mesh, own) for block, own in self.of_blocks(residual[rows:]))])

    def of_blocks(self, rows: FloatArray) -> Iterator[tuple[Block, FloatArray]]:
        """The blocks, each with its own of the rows after those of the lengths."""
        return zip(self.blocks, _split(rows, self.blocks), strict=True)

    def length_error(self, curve: Curve) -> float:
        return float(np.max(np.abs(np.log(curve.edge_lengths / self.lengths))))


@dataclass(frozen=True, eq=False)
class ConstraintDerivative:
    """DΦ(P) as an operator."""

    mesh: Mesh  # connectivity
    tangents: FloatArray  # τ_I/ℓ_I, so that the length rows are ⟨τ_I/ℓ_I, ΔU_I⟩; shape (edges, m)
    edges: IntArray  # those whose lengths are rows, ascending; shape (r,)
    pins: IntArray  # vertices at which u is 0; shape (k,)
    blocks: tuple[BlockDerivative, ...] = ()  # the derivatives of the blocks
    symmetry: Symmetry = NO_SYMMETRY

    @classmethod
    def of(
        cls, curve: Curve, pins: IntArray, edges: IntArray, blocks: tuple[BlockDerivative, ...] = ()
    ) -> "ConstraintDerivative":
        """That of the lengths of some edges, and of blocks."""
        return cls(curve.mesh, curve.edge_vectors / curve.edge_lengths[:, None] ** 2, edges, pins, blocks)

    @classmethod
    def of_lengths(cls, curve: Curve, pins: IntArray = NOWHERE) -> "ConstraintDerivative":
        """The rows of all lengths alone, those between pins with them: what is a weight need not have full rank."""
        return cls.of(curve, pins, np.arange(curve.mesh.edges))

    @property
    def shape(self) -> tuple[int, int]:
        return self.mesh.size, self.tangents.shape[1]

    @property
    def count(self) -> int:
        return len(self.edges) + sum(block.rows for block in self.blocks)

    def border(self) -> Iterator[FloatArray]:
        """The rows of the blocks one by one; shape (n, m) each."""
        for k in range(len(self.edges), self.count):
            unit = np.zeros(self.count)
            unit[k] = 1.0
            yield self.apply_transpose(unit)

    def length_rows(self) -> sp.csr_array:
        """The rows of the lengths as a sparse matrix, 0 at pins; shape (r, n·m)."""
        tangents, (n, m) = self.tangents[self.edges], self.shape
        row, coordinate = np.indices(tangents.shape)
        free = np.where(np.isin(np.arange(n), self.pins), 0.0, 1.0)
        ends = [end[self.edges] for end in (self.mesh.tails, self.mesh.heads)]
        entries = [sign * free[end][:, None] * tangents for sign, end in zip((-1.0, 1.0), ends, strict=True)]
        columns = [m * end[row] + coordinate for end in ends]
        places = (np.concatenate([row.ravel()] * 2), np.concatenate([column.ravel() for column in columns]))
        return sp.csr_array((np.ravel(entries), places), shape=(len(tangents), n * m))

    def apply(self, u: FloatArray) -> FloatArray:
        """DΦ u; shape (r + k,) from (n, m)."""
        stretch = np.einsum("ij,ij->i", self.tangents, self.mesh.changes(u))
        return np.concatenate([stretch[self.edges], *(block.apply(u, stretch) for block in self.blocks)])

    def apply_transpose(self, multipliers: FloatArray) -> FloatArray:
        """DΦᵀ λ, with the forces that pins take; shape (n, m) from (r + k,)."""
        tensions, forces = self.loads(multipliers)
        pull = tensions[:, None] * self.tangents
        return np.asarray(self.mesh.scatter(-pull, pull) + forces)

    def loads(self, multipliers: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The tensions of edges, shape (edges,), and forces on vertices, shape (n, m), of all multipliers."""
        tensions, forces = self.tensions(multipliers), np.zeros(self.shape)
        for block, own in self.of_blocks(multipliers):
            more = block.loads(own)
            tensions, forces = tensions + more[0], forces + more[1]
        return tensions, forces

    def tensions(self, multipliers: FloatArray) -> FloatArray:
        """The multipliers of the lengths by edges, 0 where there is no row; shape (edges,) from (r, …)."""
        tension = np.zeros(self.mesh.edges)
        tension[self.edges] = multipliers[: len(self.edges)]
        return tension

    def of_blocks(self, multipliers: FloatArray) -> Iterator[tuple[BlockDerivative, FloatArray]]:
        return zip(self.blocks, _split(multipliers[len(self.edges) :], self.blocks), strict=True)


def _split(rows: FloatArray, blocks: Sequence[Block] | Sequence[BlockDerivative]) -> list[FloatArray]:
    ends = accumulate((block.rows for block in blocks), initial=0)
    return [rows[first:last] for first, last in pairwise(ends)]
