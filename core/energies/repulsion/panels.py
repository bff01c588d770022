"""Panels: the dyadic intervals of edges on which potentials are integrated by Gauss points."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...curve import Mesh
from ...types import BoolArray, FloatArray, IntArray
from .vectors import norm

MAX_POINTS = 8


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges x(t) = tail + t vector, or how they move; both arrays of shape (3, n)."""

    tail: FloatArray
    vector: FloatArray

    @classmethod
    def of(cls, mesh: Mesh, vertices: FloatArray) -> "Edges":
        """Those between vertices, or the motions that come of velocities of these; shape (n, 3)."""
        tail, head = vertices.T[:, mesh.tails], vertices.T[:, mesh.heads]
        return cls(tail, head - tail)

    @cached_property
    def length(self) -> FloatArray:
        """Shape (n,)."""
        return norm(self.vector)

    def at(self, edge: IntArray, t: FloatArray) -> FloatArray:
        """Points x(t) of some edges, shape (3, k, points), for t of shape (k, points)."""
        return np.asarray(self.tail[:, edge, None] + t * self.vector[:, edge, None])


@dataclass(frozen=True, eq=False)
class Panels:
    """Parts of edges, and the cluster or simplex that each of them sees.

    Attributes
    ----------
    edge
        Shape (k,).
    begin, width
        The part is [begin, begin + width] of an edge's [0, 1], from tail to head; shape (k,).
    source
        Index of the cluster or simplex; shape (k,).
    """

    edge: IntArray
    begin: FloatArray
    width: FloatArray
    source: IntArray

    @classmethod
    def whole(cls, edge: IntArray) -> "Panels":
        """Whole edges, which see source 0."""
        return cls(edge, np.zeros(len(edge)), np.ones(len(edge)), np.zeros_like(edge))

    @classmethod
    def joined(cls, parts: "list[Panels]") -> "Panels":
        """All of them."""
        names = ("edge", "begin", "width", "source")
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    def __len__(self) -> int:
        return len(self.edge)

    def __getitem__(self, choice: slice | BoolArray | IntArray) -> "Panels":
        return Panels(self.edge[choice], self.begin[choice], self.width[choice], self.source[choice])

    def seeing(self, source: IntArray) -> "Panels":
        """The same parts of edges with other sources."""
        return Panels(self.edge, self.begin, self.width, source)

    def halved(self) -> "Panels":
        """Both halves of each."""
        half = 0.5 * self.width
        return Panels.joined([Panels(self.edge, begin, half, self.source) for begin in (self.begin, self.begin + half)])

    def middles(self, edges: Edges) -> FloatArray:
        """Midpoints; shape (3, k)."""
        return edges.at(self.edge, (self.begin + 0.5 * self.width)[:, None])[:, :, 0]

    def half_lengths(self, edges: Edges) -> FloatArray:
        """Half of their lengths; shape (k,)."""
        return np.asarray(0.5 * self.width * edges.length[self.edge])


def least_ratios(exponent: float) -> FloatArray:
    """Ratios of analytic radius to half length from which 1, 2, … Gauss points leave an error of exp(−exponent).

    k points have the error ρ⁻²ᵏ; the Bernstein ellipse lies within a disc of R half lengths if ρ + 1/ρ ≤ 2R.
    """
    return np.asarray(np.cosh(exponent / (2.0 * np.arange(1, MAX_POINTS + 1))))
