"""What the components of a curve add to its Möbius energy besides the integral of (1 − cos α)/r².

The energy is ∬ (1/r² − 1/ϱ²) (O'Hara, Energy of a knot, Topology 30, 1991), ϱ the distance along the curve.  Since
cos α/r² is ∂ₓ∂ᵧ log r, and 1/ϱ² on an arc ∂ₓ∂ᵧ log ϱ, the integral of their difference is elementary:

    4 on a closed component (Ishizeki and Nagasawa),   2 log(L/|a − b|) on an arc of length L from a to b,

the latter 0 on a straight segment and infinite where the ends meet.  Here it is counted in units of 4.
"""

from dataclasses import dataclass

import numpy as np

from ..base import FloatArray, IntArray, dot
from ..curve import Curve, Mesh
from .edge_pairs import change, stepped


def energy_scale(mesh: Mesh, energy: float) -> float:
    """The scale for errors and gradients: |E|, and for each arc, whose energy may be 0, the circle's."""
    return abs(energy) + 4.0 * len(mesh.ends)


CONSTANT = 4.0  # of a closed component


@dataclass(frozen=True, eq=False)
class ComponentShares:
    """Σ over the components of a curve: 1 for each closed one, ½ log(L/|a − b|) for each arc."""

    curve: Curve

    def value(self) -> float:
        mesh = self.curve.mesh
        first, last = self.curve.vertices[mesh.ends.T]
        lengths = self.curve.component_lengths[~np.asarray(mesh.closed)]
        chords = np.sqrt(dot(last - first, last - first))
        return float(sum(mesh.closed) + 0.5 * np.sum(np.log(lengths / chords)))

    def derivative(self) -> FloatArray:
        """Its derivative with respect to the vertices; shape (n, m)."""
        return self._derivative(self.curve.vertices)

    def second_derivative(self, v: FloatArray) -> FloatArray:
        """Its second derivative times one vector or more, shape (n, m) or (n, m, k); the same shape."""
        return change(self._derivative(stepped(self.curve.vertices.reshape(*v.shape[:2], *[1] * (v.ndim - 2)), v)))

    def hessian_columns(self) -> tuple[IntArray, FloatArray]:
        """The non-zero columns of D², those of the arcs' coordinates in ``vertices.ravel()``, and D² there."""
        n, m = self.curve.vertices.shape
        on_arcs = ~np.asarray(self.curve.mesh.closed)[self.curve.mesh.component]
        columns = np.flatnonzero(np.repeat(on_arcs, m))
        units = np.zeros((n * m, len(columns)))
        units[columns, np.arange(len(columns))] = 1.0
        return columns, self.second_derivative(units.reshape(n, m, -1)).reshape(n * m, -1)

    def _derivative(self, p: FloatArray) -> FloatArray:
        """The derivative at vertices, (n, m) or (n, m, k) for several positions, that may be after complex steps.

        By an edge vector e that of ½ log L is e/(2 ℓ L), by the chord d that of −½ log |d| is −d/(2 d²).
        """
        mesh, edges, total = self.curve.mesh, self.curve.mesh.arc_edges, np.zeros_like(p)
        if mesh.all_closed:  # as in most curves: not worth a dozen operations
            return total
        tails, heads, (first, last) = mesh.tails[edges], mesh.heads[edges], mesh.ends.T
        e, chord = p[heads] - p[tails], p[last] - p[first]
        lengths, squares = (np.einsum("ij...,ij...->i...", x, x) for x in (e, chord))
        lengths = np.sqrt(lengths)
        arc = (np.cumsum(~np.asarray(mesh.closed)) - 1)[mesh.edge_component[edges]]  # of each edge, counted from 0
        whole = np.zeros((len(mesh.ends), *lengths.shape[1:]), p.dtype)
        np.add.at(whole, arc, lengths)
        by_edge, by_chord = 0.5 * e / (lengths * whole[arc])[:, None], 0.5 * chord / squares[:, None]
        total[tails] -= by_edge
        total[heads] += by_edge
        total[first] += by_chord
        total[last] -= by_chord
        return total


def energy_of_pairs(curve: Curve, pairs: float) -> float:
    """The energy from the sum over unordered pairs."""
    return CONSTANT * ComponentShares(curve).value() + 2.0 * pairs
