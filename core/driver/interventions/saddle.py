"""Minimum or saddle: the Lagrangian's Hessian on the tangent space of the constraints, and the way off a saddle."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...curve import Curve
from ...descent import Point, Step
from ...descent.newton import Curvature
from ...descent.searches import Escape
from ...descent.soft_modes import SoftModes, smooth_starts, soft_modes
from ...metrics import MoebiusMetric
from ..outcome import Outcome
from ..run import Change, Intervention

ZERO = 1e-5  # eigenvalues against J_C below this count as 0: rotations and sliding are flat directions
MOEBIUS = 20.0  # and so do Möbius maps on a mesh: in units of (h/L)², h the longest edge, they have 11 at most at knots
RESOLVED = 1e-5  # residual at which Ritz values count as eigenvalues: their errors are of the order of its square


@dataclass(frozen=True, eq=False)
class Stability:
    """Second-order information at a critical point: D²E − Σ λ_I D²Φ_I on ker DΦ against J_C."""

    point: Point  # in the metric J_C

    @cached_property
    def zero(self) -> float:
        """Size up to which the mesh cannot distinguish an eigenvalue from 0."""
        return unresolved(self.point.curve)

    @cached_property
    def modes(self) -> SoftModes:
        """The lowest eigenvalues and eigenvectors, by some hundred products."""
        return soft_modes(self.point, smooth_starts(self.point, np.random.default_rng(1)), RESOLVED)

    @cached_property
    def index(self) -> int | None:
        """Number of negative eigenvalues: 0 at a minimum, more at a saddle; None if they could not be computed."""
        if Curvature.is_known(self.point):
            return Curvature(self.point).shifted(self.zero).negative
        negative = int(np.count_nonzero(self.modes.values < -self.zero))
        return negative if (self.modes.residuals[: negative + 1] <= RESOLVED).all() else None


def stability(point: Point) -> Stability:
    """That of a point, in the metric J_C whatever metric its problem has: eigenvalues are counted against it."""
    if point.problem.metric.name != MoebiusMetric.name:
        point = point.changing(metric=point.problem.solver.of_metric(MoebiusMetric()))
    return Stability(point)


def unresolved(curve: Curve) -> float:
    """Size of eigenvalues of Möbius maps, which change nothing of the energy but what the mesh makes of it."""
    ell = curve.edge_lengths
    return max(ZERO, MOEBIUS * max(float(ell[s].max() / ell[s].sum()) ** 2 for s in curve.mesh.edge_slices))


@dataclass(eq=False)
class EscapeSaddle(Intervention):
    """Step off a saddle along its most negative direction."""

    search: Escape = field(default_factory=Escape)

    def converged(self, outcome: Outcome) -> Outcome | Change | None:
        if not self.run.options.escape_saddles:
            return None
        found = stability(self.run.point)
        if not found.index:
            return None
        step = self.search.step(self.run.point, found.modes.vectors[0], float(found.modes.values[0]))
        return Change((step,)) if isinstance(step, Step) else outcome.adding("no step down from it was found")
