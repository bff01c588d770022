"""Terms besides the energy: bending, and the pull of a hand, a spring from a short stretch of a curve to a point."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ..base import FloatArray
from ..curve import Curve, bending, bending_and_derivative, nearest_on_edges, periods, vertex_positions

REACH = 0.5  # r, in the program's units, in which a component is 4 to 8 long


@dataclass(frozen=True, eq=False)
class Pull:
    """k r² (√(1 + |d|²/r²) − 1), d = Σ w_i P_i − target: a spring of stiffness k whose force is less than k r.

    However far away the target is, steps are as for one at the distance r, and strands in the way bear the force.
    """

    weights: FloatArray  # w, a Gaussian along the curve, of sum 1; shape (n,)
    target: FloatArray  # shape (m,)
    strength: float  # k

    name = "hand"

    @classmethod
    def at(cls, curve: Curve, component: int, share: float, strength: float) -> "Pull":
        """A pull at rest, around the point at a share of a component's length.

        The stretch has a standard deviation of 2 % of the length, or of the longest edge, and three of them either way.
        """
        length, vertices = curve.component_lengths[component], curve.mesh.slices[component]
        gap = np.abs(vertex_positions(curve)[vertices] - share * length)
        gap = np.minimum(gap, np.abs(periods(curve)[component] - gap))
        width = max(0.02 * length, float(curve.edge_lengths[curve.mesh.edge_slices[component]].max()))
        weights = np.zeros(len(curve))
        weights[vertices] = np.exp(-0.5 * (gap / width) ** 2) * (gap <= 3.0 * width)
        weights *= curve.mesh.scatter(curve.edge_lengths, curve.edge_lengths)
        weights /= weights.sum()
        return cls(weights, weights @ curve.vertices, strength)

    def on(self, old: Curve, new: Curve, rescaled: Callable[[FloatArray], FloatArray]) -> "Pull":
        """The pull of a curve on another mesh and in other units: at the same place, to the same target."""
        component = int(old.mesh.component[self.vertex])
        pull = Pull.at(new, component, share_of(new, component, rescaled(old.vertices[self.vertex])), self.strength)
        return replace(pull, target=rescaled(self.target))

    @property
    def vertex(self) -> int:
        """The vertex in the middle of the stretch."""
        return int(self.weights.argmax())

    def value(self, curve: Curve) -> float:
        return self.value_and_derivative(curve)[0]

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        d, root = self._stretched(curve)
        return float(self.strength * (d @ d) / (root + 1.0)), np.outer(self.weights, self.strength / root * d)

    def sparse_hessian(self, curve: Curve) -> sp.csr_array:
        column = sp.csr_array(self.weights[:, None])
        return sp.csr_array(sp.kron(column @ column.T, self._curvature(curve)))

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        return np.outer(self.weights, self._curvature(curve) @ (self.weights @ v))

    def stiffness(self, curve: Curve) -> sp.dia_array:
        """k Σ w_i |u_i|² ≥ k |Σ w_i u_i|²: the same for all targets, so that a metric outlives their motion."""
        return sp.diags_array(self.strength * self.weights)

    def _stretched(self, curve: Curve) -> tuple[FloatArray, float]:
        """d and √(1 + |d|²/r²)."""
        d = self.weights @ curve.vertices - self.target
        return d, float(np.sqrt(1.0 + (d @ d) / REACH**2))

    def _curvature(self, curve: Curve) -> FloatArray:
        """The second derivative by Σ w_i P_i; shape (m, m)."""
        d, root = self._stretched(curve)
        return np.asarray(self.strength / root * (np.eye(len(d)) - np.outer(d, d) / (REACH * root) ** 2))


def share_of(curve: Curve, component: int, point: FloatArray) -> float:
    """The share of a component's length at which the component is nearest to a point, shape (m,)."""
    edges = np.arange(curve.mesh.edges)[curve.mesh.edge_slices[component]]
    t, away = nearest_on_edges(curve, edges, point)
    at = (curve.arc_starts[edges] + t * curve.edge_lengths[edges])[away.argmin()]
    return float(at / curve.component_lengths[component])


@dataclass(frozen=True)
class Bending:
    """L ∫ κ² ds, 4π² on a round circle; see `core.curve.measures`."""

    name = "bending"
    description = "L ∫ κ² ds, 4π² on a round circle"
    scale_exponent = 0.0

    def value(self, curve: Curve) -> float:
        return bending(curve)

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        return bending_and_derivative(curve)

    def stiffness(self, curve: Curve) -> sp.csr_array:
        """2 L Σ |Δu₊/ℓ₊ − Δu₋/ℓ₋|²/ℓ̄, the second derivative on a nearly straight curve; shape (n, n)."""
        mesh, ell = curve.mesh, curve.edge_lengths
        slope = sp.csr_array(sp.diags_array(1.0 / ell) @ mesh.difference)
        before, after = mesh.incoming[mesh.inner], mesh.outgoing[mesh.inner]
        turn = slope[after] - slope[before]
        return sp.csr_array(turn.T @ sp.diags_array(4.0 * curve.length / (ell[before] + ell[after])) @ turn)
