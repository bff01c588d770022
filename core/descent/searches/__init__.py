"""Searches for a step, one file each: frozen values whose constants are their fields."""

from .accelerated import Accelerated
from .armijo import Armijo
from .backward_euler import BackwardEuler
from .escape import Escape
from .first_trial import FirstTrial
from .line_search import LineSearch
from .normal_step import TowardsTargets
from .trust_region import TrustRegion
from .wolfe import WeakWolfe

__all__ = [
    "Accelerated",
    "Armijo",
    "BackwardEuler",
    "Escape",
    "FirstTrial",
    "LineSearch",
    "TowardsTargets",
    "TrustRegion",
    "WeakWolfe",
]
