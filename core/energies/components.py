"""What the components of a curve add to its Möbius energy besides the integral of (1 − cos α)/r².

The energy is ∬ (1/r² − 1/ϱ²) (O'Hara, Energy of a knot, Topology 30, 1991), ϱ the distance along the curve.  Since
cos α/r² is ∂ₓ∂ᵧ log r, and 1/ϱ² on an arc ∂ₓ∂ᵧ log ϱ, the integral of their difference is elementary:

    4 on a closed component (Ishizeki and Nagasawa),   2 log(L/|a − b|) on an arc of length L from a to b,

the latter 0 on a straight segment and infinite where the ends meet.  Here it is counted in units of 4.
"""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve, Mesh
from ..types import FloatArray, IntArray


def energy_scale(mesh: Mesh, energy: float) -> float:
    """What errors and gradients are to be compared with: |E|, and for each arc, whose energy may be 0, the circle's."""
    return abs(energy) + 4.0 * len(mesh.ends)


@dataclass(frozen=True, eq=False)
class ComponentShares:
    """Σ over the components: 1 for each closed one, ½ log(L/|a − b|) for each arc."""

    curve: Curve  # the curve

    def value(self) -> float:
        """The sum."""
        chords = self._chords(self.curve.vertices)
        squares = np.einsum("ij,ij->i", chords, chords)
        return float(sum(self.curve.mesh.closed) + 0.5 * np.sum(np.log(self._lengths / np.sqrt(squares))))

    def derivative(self) -> FloatArray:
        """Its derivative with respect to the vertices; shape (n, m)."""
        if self.curve.mesh.all_closed:  # as most are: not worth a dozen operations
            return np.zeros_like(self.curve.vertices)
        chord = self._chords(self.curve.vertices)
        square = np.einsum("ij,ij->i", chord, chord)[:, None]
        return self._at_vertices(self._weights[:, None] * self._tangents, chord / square)

    def second_derivative(self, v: FloatArray) -> FloatArray:
        """Its second derivative times one vector or more, shape (n, m) or (n, m, k); the same shape."""
        mesh, tau, edges = self.curve.mesh, self._tangents, self.curve.mesh.arc_edges
        shape, v = v.shape, v.reshape(*self.curve.vertices.shape, -1)
        change, weights = v[mesh.heads[edges]] - v[mesh.tails[edges]], self._weights[:, None, None]
        along = np.einsum("ij,ijk->ik", tau, change)
        turning = (change - tau[:, :, None] * along[:, None, :]) / self.curve.edge_lengths[edges, None, None]
        growth = np.zeros((len(mesh.ends), along.shape[1]))
        np.add.at(growth, self._arc, along)
        # D²(log L)/2 is D²L/(2L) − DL DLᵀ/(2L²)
        pull = weights * (turning - 2.0 * weights * tau[:, :, None] * growth[self._arc][:, None, :])
        chord, swing = self._chords(self.curve.vertices), self._chords(v)
        square = np.einsum("ij,ij->i", chord, chord)[:, None, None]
        along = np.einsum("ij,ijk->ik", chord, swing)[:, None, :]
        return self._at_vertices(pull, (swing - 2.0 * along / square * chord[:, :, None]) / square).reshape(shape)

    def hessian_columns(self) -> tuple[IntArray, FloatArray]:
        """The columns of D² that are not 0, those of the arcs' coordinates in ``vertices.ravel()``, and D² there."""
        n, m = self.curve.vertices.shape
        on_arcs = ~np.asarray(self.curve.mesh.closed)[self.curve.mesh.component]
        columns = np.flatnonzero(np.repeat(on_arcs, m))
        units = np.zeros((n * m, len(columns)))
        units[columns, np.arange(len(columns))] = 1.0
        return columns, self.second_derivative(units.reshape(n, m, -1)).reshape(n * m, -1)

    @property
    def _arc(self) -> IntArray:
        """The arc that each edge of arcs is on, counted from 0."""
        mesh = self.curve.mesh
        return np.asarray((np.cumsum(~np.asarray(mesh.closed)) - 1)[mesh.edge_component[mesh.arc_edges]])

    @property
    def _lengths(self) -> FloatArray:
        """Length of each arc."""
        return self.curve.component_lengths[~np.asarray(self.curve.mesh.closed)]

    @property
    def _tangents(self) -> FloatArray:
        """Unit tangents of the edges of arcs."""
        edges = self.curve.mesh.arc_edges
        return self.curve.edge_vectors[edges] / self.curve.edge_lengths[edges, None]

    @property
    def _weights(self) -> FloatArray:
        """1/(2L) for the edges of arcs: the derivative of ½ log L by their lengths."""
        mesh = self.curve.mesh
        return np.asarray(0.5 / self.curve.component_lengths[mesh.edge_component[mesh.arc_edges]])

    def _chords(self, at_vertices: FloatArray) -> FloatArray:
        """From the first to the last vertex of each arc; (n, …) to (arcs, …)."""
        first, last = self.curve.mesh.ends.T
        return np.asarray(at_vertices[last] - at_vertices[first])

    def _at_vertices(self, by_edge: FloatArray, by_chord: FloatArray) -> FloatArray:
        """Derivatives by the vertices, from those by edge vectors and by the chords of −½ log |b − a|."""
        mesh, edges = self.curve.mesh, self.curve.mesh.arc_edges
        total = np.zeros((mesh.size, *by_edge.shape[1:]))
        total[mesh.tails[edges]] -= by_edge
        total[mesh.heads[edges]] += by_edge
        first, last = mesh.ends.T
        total[first] += 0.5 * by_chord
        total[last] -= 0.5 * by_chord
        return total
