"""Energies of polygons, and the table they are chosen from."""

from collections.abc import Mapping

from ..base.plugins import Table
from .barrier import Barrier
from .density import Density
from .energy import Assembled, Energy, Stiff, Term, TwiceDifferentiable, is_moebius_invariant
from .kpoint import EDGE_ENERGY, TANGENT_POINT_ENERGY, VERTEX_ENERGY, KPointEnergy, moebius_kpoint
from .moebius import MoebiusEnergy
from .objective import Objective, Weighted
from .pull import Bending
from .quadrature import Rule

ENERGIES: Mapping[str, Energy] = {
    energy.name: energy
    for energy in (
        MoebiusEnergy(),
        VERTEX_ENERGY,
        EDGE_ENERGY,
        moebius_kpoint(2),
        moebius_kpoint(3),
        TANGENT_POINT_ENERGY,
    )
}
"""Every energy that users can choose, by name; the first is the default."""

_TERMS: list[Term] = [
    Bending(),
]
TERMS: Mapping[str, Term] = Table(
    "mobius_flow.terms",
    lambda it: isinstance(it, Term) and not isinstance(it, type),
    {term.name: term for term in _TERMS},
)
"""What users can add to an energy, by name; packages join by entry points in ``mobius_flow.terms``."""
