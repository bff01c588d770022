"""Minimum or saddle: the Lagrangian's Hessian on the tangent space of the constraints, and the way off a saddle."""

from dataclasses import dataclass, field, replace

import numpy as np

from ...curve import Curve
from ...descent import Point, Step
from ...descent.searches import Escape
from ...descent.soft_modes import SoftModes, smooth_starts, soft_modes
from ...metrics import MoebiusMetric
from ..outcome import Outcome
from ..run import Change, Intervention

MINIMUM = "a minimum"
ILL_CONDITIONED = "the Hessian is too ill-conditioned to tell a minimum from a saddle"
ZERO = 1e-5  # eigenvalues against J_C below this count as 0: rotations and sliding are flat directions
MOEBIUS = 20.0  # and so do Möbius maps on a mesh: in units of (h/L)², h the longest edge, they have 11 at most at knots
RESOLVED = 1e-5  # residual at which Ritz values count as eigenvalues: their errors are of the order of its square


@dataclass(frozen=True, eq=False)
class Stability:
    """Second-order information at a critical point."""

    modes: SoftModes  # the lowest eigenvalues and eigenvectors against J_C
    zero: float  # size up to which the mesh cannot distinguish an eigenvalue from 0

    @property
    def index(self) -> int | None:
        """Number of negative eigenvalues: 0 at a minimum, more at a saddle; None if they could not be computed."""
        negative = int(np.count_nonzero(self.modes.values < -self.zero))
        return negative if (self.modes.residuals[: negative + 1] <= RESOLVED).all() else None


def stability(point: Point) -> Stability:
    """The lowest eigenvalues of D²E − Σ λ_I D²Φ_I on ker DΦ against J_C, by some hundred products."""
    modes = soft_modes(point, smooth_starts(point, np.random.default_rng(1)), RESOLVED)
    return Stability(modes, _unresolved(point.curve))


def _unresolved(curve: Curve) -> float:
    """Size of eigenvalues of Möbius maps, which change nothing of the energy but what the mesh makes of it."""
    ell = curve.edge_lengths
    return max(ZERO, MOEBIUS * max(float(ell[s].max() / ell[s].sum()) ** 2 for s in curve.mesh.edge_slices))


@dataclass(eq=False)
class EscapeSaddle(Intervention):
    """Report the index of a critical point; step off a saddle along its most negative direction."""

    search: Escape = field(default_factory=Escape)

    def converged(self, outcome: Outcome) -> Outcome | Change | None:
        options = self.run.options
        if not (options.stability or options.escape_saddles):
            return None
        found = stability(self._point())
        outcome = replace(outcome, negative_eigenvalues=found.index)
        if not found.index:
            return outcome.adding(ILL_CONDITIONED if found.index is None else MINIMUM)
        outcome = outcome.adding("a saddle of index {index}", index=found.index)
        if not options.escape_saddles:
            return outcome
        step = self.search.step(self.run.point, found.modes.vectors[0], float(found.modes.values[0]))
        return Change((step,)) if isinstance(step, Step) else outcome.adding("no step down from it was found")

    def _point(self) -> Point:
        """The present one in J_C, against which eigenvalues are counted whatever metric steps are taken in."""
        point = self.run.point
        if point.problem.metric.name == MoebiusMetric.name:
            return point
        return point.changing(metric=point.problem.solver.of_metric(MoebiusMetric()))
