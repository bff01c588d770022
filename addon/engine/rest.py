"""Where a relaxation leads: the least energy that there can be, and a plot of the way."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core import Curve, RelaxOptions, Task
from ...core.base import FloatArray, Message
from ...core.knots.diagrams import quick_invariants

CIRCLE = 4.0  # Möbius energy of the round circle, the least of any closed curve: Freedman, He and Wang (1994)


@dataclass(frozen=True)
class Target:
    """A least energy, and its label in the plot."""

    energy: float
    label: Message


def target_of(curve: Curve | Task, options: RelaxOptions, most: int = 2000) -> Target | None:
    """The least energy that a curve may come down to; None if nothing useful is known.

    A closed component has at least the energy of a circle, and a knotted one far more: a curve whose Alexander
    polynomial shows that it is knotted has no target. An arc has at least the energy of a segment, and comes near it
    if its ends are free. Pins and obstacles keep curves far above that. The type of curves with more than ``most``
    vertices, which takes a tenth of a second, is left open.
    """
    task = Task.of(curve)
    if options.energy != "moebius" or options.terms or task.pins or task.obstacles:
        return None
    curve = task.curve
    closed = curve.mesh.closed
    if closed == (False,):
        return Target(0.0, Message("straight = {energy:g}", energy=0.0))
    if len(closed) > 1:
        floor = CIRCLE * sum(closed)
        return Target(floor, Message("floor = {energy:g}", energy=floor))
    knotted = len(curve) <= most and not quick_invariants(curve).is_trivial
    return None if knotted else Target(CIRCLE, Message("circle = {energy:g}", energy=CIRCLE))


def plot(
    energies: Sequence[float], target: Target | None, width: float, height: float
) -> tuple[FloatArray, float | None]:
    """Lay out the energies of the iterates, of which there is at least one, and their target.

    Returns the line of the energies, at most two points for a pixel's width, (k, 2), and the height of that of the
    target, if there is one, in pixels from the lower left corner.
    """
    count = len(energies)  # of which the first, the last, and evenly spread ones in between are drawn
    chosen = np.unique(np.linspace(0, count - 1, min(count, max(2 * int(width), 2))).round().astype(np.intp))
    values = np.asarray(energies, dtype=np.float64)[chosen]
    low = min(values.min(), np.inf if target is None else target.energy)
    scale = np.log if low > 0.0 and 10.0 * low < values.max() else np.positive
    bottom, top = scale(np.array([low, values.max()]))

    def heights(of: FloatArray) -> FloatArray:
        share = (scale(of) - bottom) / (top - bottom) if top > bottom else np.full(of.shape, 0.5)
        return np.asarray(height * (0.06 + 0.88 * share))

    x = width * chosen / max(count - 1, 1)
    level = None if target is None else float(heights(np.array([target.energy]))[0])
    return np.column_stack([x, heights(values)]), level
