"""The energy of a curve as it stands: what ``mobius-flow energy`` prints and a report's ``final_energy`` is."""

from .arguments import checked, named
from .collision import check_embedded, check_gap
from .curve import Curve
from .energies import ENERGIES, MoebiusEnergy
from .errors import CurveError
from .hierarchy import moebius_energy
from .system.threads import BLAS
from .units import centred, check_units

MAX_VERTICES = 50_000  # of energies that sum over all pairs of edges: a minute or so, growing with the square


@BLAS.bounded()
@checked
def measure(curve: Curve, energy: str = "moebius") -> float:
    """The energy of a curve, in the user's units.

    Raises
    ------
    CurveError
        If the curve has too many vertices, touches itself, or has strands too near, or units too large or small, to
        compute with.
    OptionError
        If the energy is unknown.
    """
    wanted = named(ENERGIES, "energy", energy)
    check_units(curve)
    check_embedded(curve)
    check_gap(curve)
    if isinstance(wanted, MoebiusEnergy):
        return moebius_energy(centred(curve))[0]
    if len(curve) > MAX_VERTICES:
        raise CurveError(f"the curve has {len(curve)} vertices; {wanted.name} is for at most {MAX_VERTICES}")
    return wanted.value(centred(curve))
