"""Searches for a step: frozen values whose constants are their fields."""

from .armijo import Armijo, FirstTrial, LineSearch, TowardsTargets
from .backward_euler import BackwardEuler
from .trust_region import Escape, TrustRegion
from .wolfe import Accelerated, WeakWolfe
