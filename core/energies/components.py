"""What the components of a curve add to its Möbius energy besides the integral of (1 − cos α)/r².

The energy is ∬ (1/r² − 1/ϱ²) (O'Hara, Energy of a knot, Topology 30, 1991), ϱ the distance along the curve.  Since
cos α/r² is ∂ₓ∂ᵧ log r, and 1/ϱ² on an arc ∂ₓ∂ᵧ log ϱ, the integral of their difference is elementary:

    4 on a closed component (Ishizeki and Nagasawa),   2 log(L/|a − b|) on an arc of length L from a to b,

the latter 0 on a straight segment and infinite where the ends meet.  Here it is counted in units of 4.
"""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve
from ..types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class ComponentShares:
    """Σ over the components: 1 for each closed one, ½ log(L/|a − b|) for each arc.

    Parameters
    ----------
    curve
        The curve.
    """

    curve: Curve

    def value(self) -> float:
        """The sum."""
        mesh = self.curve.mesh
        lengths = self.curve.component_lengths[~np.asarray(mesh.closed)]
        chords = np.linalg.norm(self._chords(self.curve.vertices), axis=1)
        return float(sum(mesh.closed) + 0.5 * np.sum(np.log(lengths / chords)))

    def derivative(self) -> FloatArray:
        """Its derivative with respect to the vertices; shape (n, m)."""
        chord = self._chords(self.curve.vertices)
        square = np.einsum("ij,ij->i", chord, chord)[:, None]
        return self._at_vertices(self._weights[:, None] * self._tangents, chord / square)

    def second_derivative(self, v: FloatArray) -> FloatArray:
        """Its second derivative times one vector or more, shape (n, m) or (n, m, k); the same shape."""
        mesh, tau = self.curve.mesh, self._tangents
        shape, v = v.shape, v.reshape(*self.curve.vertices.shape, -1)
        change, weights = v[mesh.heads] - v[mesh.tails], self._weights[:, None, None]
        along = np.einsum("ij,ijk->ik", tau, change)
        turning = (change - tau[:, :, None] * along[:, None, :]) / self.curve.edge_lengths[:, None, None]
        growth = np.add.reduceat(along, mesh.edge_offsets[:-1])[mesh.edge_component]
        # D²(log L)/2 is D²L/(2L) − DL DLᵀ/(2L²)
        pull = weights * (turning - 2.0 * weights * tau[:, :, None] * growth[:, None, :])
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
    def _tangents(self) -> FloatArray:
        return self.curve.edge_vectors / self.curve.edge_lengths[:, None]

    @property
    def _weights(self) -> FloatArray:
        """1/(2L) on the edges of arcs, 0 on others: the derivative by their lengths; shape (edges,)."""
        mesh = self.curve.mesh
        return np.asarray(np.where(mesh.closed, 0.0, 0.5 / self.curve.component_lengths)[mesh.edge_component])

    def _chords(self, at_vertices: FloatArray) -> FloatArray:
        """From the first to the last vertex of each arc; (n, …) to (arcs, …)."""
        first, last = self.curve.mesh.ends.T
        return np.asarray(at_vertices[last] - at_vertices[first])

    def _at_vertices(self, by_edge: FloatArray, by_chord: FloatArray) -> FloatArray:
        """Derivatives by the vertices, from those by edge vectors and by the chords of −½ log |b − a|."""
        total = self.curve.mesh.scatter(-by_edge, by_edge)
        first, last = self.curve.mesh.ends.T
        total[first] += 0.5 * by_chord
        total[last] -= 0.5 * by_chord
        return total
