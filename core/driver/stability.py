"""Minimum or saddle: the Lagrangian's Hessian on the tangent space of the constraints."""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve
from ..descent import Point
from ..descent.soft_modes import SoftModes, smooth_starts, soft_modes

ZERO = 1e-5  # eigenvalues against J_C below this count as 0: rotations and sliding are flat directions
MOEBIUS = 20.0  # and so do Möbius maps on a mesh: in units of (h/L)², h the longest edge, they have 11 at most at knots
RESOLVED = 1e-5  # residual at which Ritz values count as eigenvalues: their errors are of the order of its square


@dataclass(frozen=True, eq=False)
class Stability:
    """Second-order information at a critical point.

    Attributes
    ----------
    modes
        The lowest eigenvalues and eigenvectors against J_C.
    zero
        Size up to which the mesh cannot tell an eigenvalue from 0.
    """

    modes: SoftModes
    zero: float

    @property
    def index(self) -> int | None:
        """Number of negative eigenvalues: 0 at a minimum, more at a saddle; None if they could not be computed."""
        negative = int(np.count_nonzero(self.modes.values < -self.zero))
        return negative if (self.modes.residuals[: negative + 1] <= RESOLVED).all() else None


def stability(point: Point) -> Stability:
    """The lowest eigenvalues of D²E − Σ λ_I D²Φ_I on ker DΦ, against the metric, which should be J_C.

    Some hundred products and projections, whatever the number of vertices.
    """
    modes = soft_modes(point, smooth_starts(point, np.random.default_rng(1)), RESOLVED)
    return Stability(modes, _unresolved(point.curve))


def _unresolved(curve: Curve) -> float:
    """Size of eigenvalues of Möbius maps, which change nothing of the energy but what the mesh makes of it."""
    ell = curve.edge_lengths
    return max(ZERO, MOEBIUS * max(float(ell[s].max() / ell[s].sum()) ** 2 for s in curve.mesh.edge_slices))
