"""Rules for descent directions, one file each."""

from .conjugate_gradient import ConjugateGradient
from .direction import Direction
from .lbfgs import LimitedMemoryBFGS
from .steepest import SteepestDescent

__all__ = ["ConjugateGradient", "Direction", "LimitedMemoryBFGS", "SteepestDescent"]
