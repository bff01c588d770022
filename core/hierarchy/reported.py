"""The Möbius energy that users are told: exact where there is time for it, else with an estimate of its error."""

from ..curve import Curve
from ..energies.moebius import MoebiusEnergy
from ..system.threads import BLAS
from .energy import HierarchicalMoebiusEnergy
from .sampling import energy_error

EXACT_UP_TO = 30_000  # vertices; all pairs of edges take some fifteen seconds there


@BLAS.bounded()
def moebius_energy(curve: Curve) -> tuple[float, float]:
    """The energy, and a bound of its relative error that holds with 95 % probability: 0 up to `EXACT_UP_TO` vertices.

    Beyond it is the hierarchical sum, whose error dense rows of sampled edges tell.
    """
    if len(curve) <= EXACT_UP_TO:
        return MoebiusEnergy().value(curve), 0.0
    energy = HierarchicalMoebiusEnergy()
    value = energy.value(curve)
    return value, energy_error(energy, curve).bound / value
