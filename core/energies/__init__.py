"""Energies of polygons: one file each."""

from .barrier import Barrier
from .moebius import MoebiusEnergy
from .objective import Objective

__all__ = ["Barrier", "MoebiusEnergy", "Objective"]
