"""What ropes minimise that are to move as little as they can, and the steps that they take.

Of all displacements u from the given curve, with R the radius of each component, they minimise

    ½ Σ ∫ (a |u|²/R² + T |u'|² + b R² |u''|²) ds / R

among those that keep clear, by Newton steps with the Gauss–Newton part of the barrier in `clearances`.  Lengths that
are to be kept are held by an augmented Lagrangian.
"""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ..base import BoolArray, FloatArray, check_time
from ..collision import is_rope, rope_motion
from ..curve import Curve, Obstacle
from ..io.trajectory import Iterate
from ..solve.saddle.tangent_space import factorised
from .clearances import Clearances, clearances

INEXTENSIBLE = 1000.0  # stiffness of kept lengths


def stiffness(curve: Curve, radius: FloatArray, a: float = 1e-3, T: float = 0.02, b: float = 0.3) -> sp.csr_array:
    """K with ½ uᵀKu the quadratic form, for each coordinate of a displacement; shape (n, n).

    Bends are some four radii long.
    """
    mesh, ell = curve.mesh, curve.edge_lengths
    R, own = radius[mesh.edge_component], radius[mesh.component]
    slope = (sp.diags_array(1.0 / ell) @ mesh.difference).tocsr()
    before, after = mesh.incoming[mesh.inner], mesh.outgoing[mesh.inner]
    turn = slope[after] - slope[before]
    anchor = sp.diags_array(a * mesh.scatter(0.5 * ell, 0.5 * ell) / own**3)
    tension = slope.T @ sp.diags_array(T * ell / R) @ slope
    bending = turn.T @ sp.diags_array(2.0 * b * own[mesh.inner] / (ell[before] + ell[after])) @ turn
    return (anchor + tension + bending).tocsr()


class Ropes:
    """What is minimised, with a share of the radii that is kept, and its Newton steps."""

    def __init__(
        self, given: Curve, radius: FloatArray, held: BoolArray, obstacles: Sequence[Obstacle], keep: bool
    ) -> None:
        self.given, self.radius, self.held, self.obstacles = given, radius, held, obstacles
        self.stiffness = stiffness(given, radius)
        self.full = sp.kron(self.stiffness, sp.eye_array(3)).tocsc()
        self.free = np.flatnonzero(np.repeat(~held, 3))
        self.weight = 1.0  # of the barrier
        self.share, self.most = 0.0, 1.0  # of the radii that are kept, and that what is held allows
        self.keep, self.pull = keep, np.zeros(given.mesh.edges)  # multipliers of lengths that are kept

    def near(self, curve: Curve, within: float) -> tuple[Clearances, Clearances]:
        """What is nearer than ``within`` times what it needs: what moves, and what is held."""
        found = clearances(curve, self.radius, self.given.edge_lengths, within, self.obstacles)
        still = (self.held[found.vertices] | (found.first == 0.0).all(axis=2)).all(axis=1)
        return Clearances(*(each[~still] for each in found)), Clearances(*(each[still] for each in found))

    def room(self, curve: Curve) -> float:
        """The share of the radii that there is room for, up to 1.25; what is held may allow no more than ``most``."""
        moving, still = self.near(curve, 1.25)
        self.most = min(1.0, (1.0 - 1e-6) * float(still.value.min(initial=2.0)))
        return float(moving.value.min(initial=1.25))

    def thicken(self, curve: Curve, share: float) -> None:
        """Keep a larger share of the radii from now on, if it is larger: no more than the curve is proved a rope of."""
        share = min(share, self.most)
        while share > max(self.share, 1e-12):
            if is_rope(curve.mesh, curve.vertices, curve.vertices, share * self.radius, self.obstacles):
                self.share = share
            share = max(0.7 * share, self.share)

    def stretches(self, curve: Curve) -> tuple[FloatArray, FloatArray]:
        """Changes of length over radius, and the tension that they and the multipliers make; shape (edges,)."""
        stretch = (curve.edge_lengths - self.given.edge_lengths) / self.radius[curve.mesh.edge_component]
        return stretch, self.pull + INEXTENSIBLE * stretch

    def length_error(self, curve: Curve) -> float:
        """The largest relative change of a length that is to be kept."""
        return 0.0 if not self.keep else float(np.abs(curve.edge_lengths / self.given.edge_lengths - 1.0).max())

    def value(self, curve: Curve, near: Clearances, share: float, begins: float) -> float:
        """What is minimised; infinite where ropes meet."""
        total = self.energy(curve) + self.weight * float(near.barrier(share, begins)[0].sum())
        if self.keep:
            stretch, tension = self.stretches(curve)
            total += 0.5 * float(stretch @ (tension + self.pull))
        return total

    def step(self, curve: Curve) -> tuple[Curve | None, float, float]:
        """The proved end of a Newton step that lowers what is minimised, None without one, its size, the decrement.

        The decrement is twice what the whole step would lower it by if it were quadratic.
        """
        if not len(self.free):
            return None, 0.0, 0.0
        # the barrier begins at 1.2 of what is needed, at first at 8 of what is kept: what is nearest moves first
        n, mesh, share, begins = len(curve), curve.mesh, self.share, min(1.2 * self.most, 8.0 * self.share)
        near, _ = self.near(curve, begins)
        _, slope, curvature = near.barrier(share, begins)
        g = self.stiffness @ (curve.vertices - self.given.vertices) + self.weight * near.sum_first(slope, n)
        H = self.full + self.weight * near.sum_squares(curvature, n)
        if self.keep:
            _, tension = self.stretches(curve)
            scale, tau = self.radius[mesh.edge_component], curve.edge_vectors / curve.edge_lengths[:, None]
            spread = sp.kron(mesh.difference, sp.eye_array(3)).tocsr()
            along = sp.block_diag([*map(sp.coo_array, (tau / scale[:, None])[:, None])], format="csr") @ spread
            across = (np.maximum(tension, 0.0) / scale / curve.edge_lengths)[:, None, None]
            across = across * (np.eye(3) - tau[:, :, None] * tau[:, None])
            taut = sp.block_diag([*map(sp.coo_array, across)], format="csr")
            g = g + (along.T @ tension).reshape(n, 3)
            H = H + INEXTENSIBLE * along.T @ along + spread.T @ taut @ spread
        try:
            factor = factorised(H[self.free][:, self.free], symmetric=True)
        except np.linalg.LinAlgError:  # singular to working precision: the barrier has outgrown all else
            return None, 0.0, 0.0
        flat = np.zeros(3 * n)
        flat[self.free] = -factor.solve(g.ravel()[self.free])
        move, decrement = flat.reshape(n, 3), -float(g.ravel() @ flat)
        before = self.value(curve, near, share, begins)
        # no further than the radius at a time: a barrier knows nothing of what lies behind what is near
        size = 0.9 / max(0.9, float((np.linalg.norm(move, axis=1) / self.radius[mesh.component]).max()))
        while size > 1e-7:
            check_time()
            end = curve.with_vertices(curve.vertices + size * move)
            if self.value(end, self.near(end, begins)[0], share, begins) <= before - 1e-4 * size * decrement:
                motion = rope_motion(mesh, curve.vertices, end.vertices, share * self.radius, self.obstacles)
                if motion.proved:
                    return end, size, decrement
                size *= max(0.75 * motion.time, 0.25)
            else:
                size *= 0.5
        return None, 0.0, decrement

    def energy(self, curve: Curve) -> float:
        """The quadratic form of the displacement."""
        u = curve.vertices - self.given.vertices
        return 0.5 * float((self.stiffness @ u * u).sum())

    def iterate(self, index: int, curve: Curve, size: float = 0.0, decrement: float = 0.0) -> Iterate:
        """An iterate that is a rope of the share of the radii that is kept."""
        return Iterate(
            index=index,
            curve=curve,
            energy=self.energy(curve),
            gradient_norm=float(np.sqrt(max(decrement, 0.0))),
            step_size=size,
            path=(curve.vertices,) if index else (),
            certified=True,
            edge_length_error=float(np.abs(np.log(curve.edge_lengths / self.given.edge_lengths)).max()),
            method="separate",
            pins=tuple(np.flatnonzero(self.held).tolist()),
            radius=tuple((self.share * self.radius).tolist()) if self.share else None,
        )
