"""Energies of polygons: one file each, and the table they are chosen from."""

from .barrier import Barrier
from .energy import Energy, TwiceDifferentiable
from .moebius import MoebiusEnergy
from .objective import Objective

ENERGIES: dict[str, Energy] = {energy.name: energy for energy in (MoebiusEnergy(),)}
"""Every energy that users can choose, by name; the first is the default."""

__all__ = ["ENERGIES", "Barrier", "Energy", "MoebiusEnergy", "Objective", "TwiceDifferentiable"]
