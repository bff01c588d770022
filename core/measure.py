"""The energy of a curve as it stands: what ``mobius-flow energy`` prints and a report's ``final_energy`` is."""

from .checks import named
from .collision import check_embedded, check_gap
from .curve import Curve, check_is_curve
from .energies import ENERGIES
from .units import centred, check_units


def measure(curve: Curve, energy: str = "moebius") -> float:
    """The energy of a curve, in the user's units.

    Raises
    ------
    CurveError
        If the curve touches itself, or strands are too near, or units too large or small, to compute with.
    OptionError
        If the energy is unknown.
    """
    check_is_curve(curve)
    wanted = named(ENERGIES, "energy", energy)
    check_units(curve)
    check_embedded(curve)
    check_gap(curve)
    return wanted.value(centred(curve))
