"""The energy below which no relaxation can get, where one is known."""

from dataclasses import dataclass

from ...core import Curve, RelaxOptions, Task
from ...core.knots.alexander import TRIVIAL, signature
from ...core.messages import Message

CIRCLE = 4.0  # Möbius energy of the round circle, the least of any closed curve: Freedman, He and Wang (1994)
SEGMENT = 0.0  # that of the straight segment, the least of any arc
_MOST = 2000  # vertices of a curve whose type is looked at: a tenth of a second


@dataclass(frozen=True)
class Target:
    """A least energy, and what has it."""

    energy: float
    label: Message


def target_of(curve: Curve | Task, options: RelaxOptions) -> Target | None:
    """What the energy of a curve goes down to at the least; None if nothing useful is known.

    A closed component has at least the energy of a circle, which a knotted one is far from: a curve whose Alexander
    polynomial shows that it is knotted has no target. An arc has at least that of a segment, which it comes near to
    where its ends are free. Pins and obstacles keep curves far above that.
    """
    task = Task.of(curve)
    if options.energy != "moebius" or options.terms or task.pins or task.obstacles:
        return None
    curve = task.curve
    closed = curve.mesh.closed
    if closed == (False,):
        return Target(SEGMENT, Message("straight = {energy:g}", energy=SEGMENT))
    if len(closed) > 1:
        floor = CIRCLE * sum(closed)
        return Target(floor, Message("floor = {energy:g}", energy=floor))
    knotted = len(curve) <= _MOST and signature(curve).alexander != (TRIVIAL,)
    return None if knotted else Target(CIRCLE, Message("circle = {energy:g}", energy=CIRCLE))
