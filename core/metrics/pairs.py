"""What the nonlocal metrics share: stripes of pair matrices, and forms in differences of edge values."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..curve import Curve, Mesh
from ..curve.tiles import ROWS_TIMES_COLUMNS
from ..types import FloatArray, IntArray


class Stencil(NamedTuple):
    """A linear map from vertices to edges, (B U)_I = tail_I U(I↓) + head_I U(I↑); both of shape (n,).

    Here an edge has the number of its tail.  The vertex where an arc ends stands for an edge from there to the arc's
    first vertex, which makes every component a cycle: its length, and with it its weight in all sums, is 0.
    """

    tail: FloatArray
    head: FloatArray

    @classmethod
    def value(cls, mesh: Mesh, t: float) -> "Stencil":
        """The values at parameter ``t`` of each edge."""
        return cls(np.full(mesh.size, 1.0 - t), np.full(mesh.size, t))

    @classmethod
    def slope(cls, curve: Curve) -> "Stencil":
        """ΔU_I/ℓ_I."""
        slope = curve.mesh.at_tails(1.0 / curve.edge_lengths)
        return cls(-slope, slope)


class Stripe(NamedTuple):
    """The pairs of edges that make the entries (v, w), v ≤ w, of a form, for consecutive vertices v of one component.

    Attributes
    ----------
    rows
        The edges that they belong to: the one before the first vertex, then those that begin at the vertices.
    """

    vertices: slice  # the vertices v
    rows: IntArray
    columns: slice  # the edges that the vertices from the first v on belong to

    def exclude_neighbours(self, mesh: Mesh, distance: FloatArray) -> None:
        """Set the distances, shape (rows, columns), of edges that share a vertex to inf."""
        for partner in (self.rows, mesh.cycle[self.rows], mesh.anticycle[self.rows]):
            row = np.flatnonzero(partner >= self.columns.start)
            distance[row, partner[row] - self.columns.start] = np.inf


def stripes(mesh: Mesh) -> Iterator[Stripe]:
    """Cover the upper triangle, in pieces that fit the processor's cache."""
    for component in mesh.slices:
        first = component.start
        while first < component.stop:
            last = min(component.stop, first + max(1, ROWS_TIMES_COLUMNS // (mesh.size - first)))
            before = int(mesh.anticycle[first])
            columns = slice(min(first, before), mesh.size)
            yield Stripe(slice(first, last), np.concatenate([[before], np.arange(first, last)]), columns)
            first = last


class DifferenceForm:
    """Collects the matrix of U ↦ Σ w_IJ ((B U)_I − (B' U)_J)² over ordered pairs of edges.

    The sum over all terms must not change if edges change places: weights are known for half of the pairs.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        self._cross = np.zeros((mesh.size, mesh.size))  # Bᵀ w B', the upper triangle
        self._squares = np.zeros((3, mesh.size))  # of tail and head of each edge, and half of their product

    def add(self, stripe: Stripe, weights: FloatArray, left: Stencil, right: Stencil) -> None:
        """Add a stripe of a term; ``weights`` has shape (rows, columns) and is changed.

        Taking first rows and then columns together at their common vertices is Bᵀ w B' at a few operations an entry.
        """
        vertices, rows, columns = stripe
        own = vertices.start - columns.start
        # the pairs of the stripe's own edges come in either order, and so count by their rows alone
        inside, beyond = weights[1:, own:], weights[1:, own + len(rows) - 1 :]
        self._add_squares(vertices, left, inside.sum(axis=1))
        self._add_squares(slice(vertices.stop, None), right, beyond.sum(axis=0))
        at_vertices = left.tail[rows[1:], None] * weights[1:]
        weights *= left.head[rows, None]
        at_vertices += weights[:-1]
        at_tails = at_vertices[:, own:] * right.tail[vertices.start :]
        at_vertices *= right.head[columns]
        at_tails += at_vertices.take(self._mesh.anticycle[vertices.start :] - columns.start, axis=1)
        self._cross[vertices, vertices.start :] += at_tails

    def assembled(self) -> FloatArray:
        """Finish: the matrix, shape (n, n), in Fortran order, of which only the lower triangle counts."""
        mesh = self._mesh
        tail, head, mixed = self._squares
        form = np.multiply(self._cross, -2.0, out=self._cross)
        tails, heads = np.arange(mesh.size), mesh.cycle
        np.add.at(form, (tails, tails), 2.0 * tail)
        np.add.at(form, (heads, heads), 2.0 * head)
        np.add.at(form, (np.minimum(tails, heads), np.maximum(tails, heads)), 2.0 * mixed)
        return form.T

    def _add_squares(self, edges: slice, stencil: Stencil, weights: FloatArray) -> None:
        tail, head = stencil.tail[edges], stencil.head[edges]
        self._squares[:, edges] += weights * np.stack([tail * tail, head * head, tail * head])
