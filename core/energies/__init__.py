"""Energies of polygons, and the table they are chosen from."""

from collections.abc import Mapping
from numbers import Real

import numpy as np

from ..base.arguments import check_known
from ..base.errors import OptionError
from ..base.plugins import Table
from .barrier import Barrier
from .density import Density
from .energy import Energy, Stiff, Term, TwiceDifferentiable, is_moebius_invariant
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


def is_weighted(value: object) -> bool:
    """Whether a value is a pair of a term, or the name of one, and a number."""
    if not (isinstance(value, tuple | list) and len(value) == 2):
        return False
    term, weight = value
    if isinstance(term, str):
        check_known("term", term, TERMS)
    known = isinstance(term, str) or (isinstance(term, Term) and not isinstance(term, type))
    try:
        return known and isinstance(weight, Real) and not isinstance(weight, bool) and bool(np.isfinite(float(weight)))
    except OverflowError:  # whole numbers too large for a float
        return False


def weighted_term(text: str) -> tuple[tuple[str, float]]:
    """A term's name and its weight from a text with = between; an OptionError if it is none."""
    name, _, weight = text.partition("=")
    try:
        return ((name, float(weight)),)
    except ValueError:
        raise OptionError(f"{text!r:.40} is not NAME=WEIGHT, such as bending=0.1") from None
