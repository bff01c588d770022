"""The energy below which no relaxation can get, where one is known."""

from dataclasses import dataclass

from ...core import Curve, RelaxOptions
from ...core.knots.alexander import TRIVIAL, signature
from .phrase import Phrase

CIRCLE = 4.0  # Möbius energy of the round circle, the least of any closed curve: Freedman, He and Wang (1994)
_MOST = 2000  # vertices of a curve whose type is looked at: a tenth of a second


@dataclass(frozen=True)
class Target:
    """A least energy, and what has it."""

    energy: float
    label: Phrase


def target_of(curve: Curve, options: RelaxOptions) -> Target | None:
    """What the energy of a curve goes down to at the least; None if nothing useful is known.

    A component has at least the energy of a circle, which a knotted one is far from: a curve whose Alexander
    polynomial shows that it is knotted has no target.
    """
    if options.energy != "moebius":
        return None
    components = len(curve.mesh.component_sizes)
    if components > 1:
        return Target(CIRCLE * components, Phrase("floor = {energy:g}", energy=CIRCLE * components))
    knotted = len(curve) <= _MOST and signature(curve).alexander != (TRIVIAL,)
    return None if knotted else Target(CIRCLE, Phrase("circle = {energy:g}", energy=CIRCLE))
