"""Where a relaxation leads: the least energy that there can be, whether it is at rest there, and a plot of the way."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core import Curve, CurveError, RelaxOptions, Status, Task, minimize
from ...core.diagrams import quick_invariants
from ...core.messages import Message
from ...core.types import FloatArray

CIRCLE = 4.0  # Möbius energy of the round circle, the least of any closed curve: Freedman, He and Wang (1994)
SEGMENT = 0.0  # that of the straight segment, the least of any arc
_MOST = 2000  # most vertices of a curve whose type is identified: a tenth of a second
MAX_POINTS = 1500  # some ten seconds
_ITERATIONS = 100  # that lead from points rounded to Blender's numbers back to a critical point
_DECADE = 10.0  # ratio of energies from which they are drawn on a logarithmic scale
_ROOM = 0.06  # of the height, kept free above and below


@dataclass(frozen=True)
class Rest:
    """Where a curve rests."""

    index: int | None  # number of independent directions that lead down, None if it is not at rest
    words: str  # the same in words

    @classmethod
    def of(cls, curve: Curve | Task, options: RelaxOptions) -> "Rest":
        """Look at the end of a relaxation that was done with these options.

        Raises MobiusFlowError if the curve has too many points, or the options leave no way to tell.
        """
        task = Task.of(curve)
        if len(task.curve) > MAX_POINTS:
            sentence = "The curves have {count} points; minimum or saddle is decided up to {most}"
            raise CurveError(Message(sentence, count=len(task.curve), most=MAX_POINTS))
        options = replace(options.at_rest(task.curve), max_iterations=_ITERATIONS, stability=True)
        result = minimize(task, options)
        index = result.outcome.negative_eigenvalues
        if result.status is Status.ITERATION_LIMIT:
            return cls(None, Message("not at rest yet; press Continue first"))
        if index is None:
            return cls(None, result.message)
        if not index:
            return cls(0, Message("at a minimum, no small motion lowers the energy"))
        if index == 1:
            return cls(1, Message("at a saddle, one way leads down; press Leave Saddle"))
        return cls(index, Message("at a saddle, {count} independent ways lead down; press Leave Saddle", count=index))


@dataclass(frozen=True)
class Target:
    """A least energy, and its label in the plot."""

    energy: float
    label: Message


def target_of(curve: Curve | Task, options: RelaxOptions) -> Target | None:
    """The least energy that a curve may come down to; None if nothing useful is known.

    A closed component has at least the energy of a circle, and a knotted one far more: a curve whose Alexander
    polynomial shows that it is knotted has no target. An arc has at least the energy of a segment, and comes near it
    if its ends are free. Pins and obstacles keep curves far above that.
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
    knotted = len(curve) <= _MOST and not quick_invariants(curve).is_trivial
    return None if knotted else Target(CIRCLE, Message("circle = {energy:g}", energy=CIRCLE))


@dataclass(frozen=True, eq=False)
class Plot:
    """What is drawn, in pixels from the lower left corner."""

    line: FloatArray  # the energies; shape (k, 2), at most two points for a pixel's width
    target: float | None  # height of the target's line, if there is one


def plot(energies: Sequence[float], target: Target | None, width: float, height: float) -> Plot:
    """Lay out the energies of the iterates, of which there is at least one, and their target."""
    count = len(energies)  # of which the first, the last, and evenly spread ones in between are drawn
    chosen = np.unique(np.linspace(0, count - 1, min(count, max(2 * int(width), 2))).round().astype(np.intp))
    values = np.asarray(energies, dtype=np.float64)[chosen]
    low = min(values.min(), np.inf if target is None else target.energy)
    scale = np.log if low > 0.0 and _DECADE * low < values.max() else np.positive
    bottom, top = scale(np.array([low, values.max()]))

    def heights(of: FloatArray) -> FloatArray:
        share = (scale(of) - bottom) / (top - bottom) if top > bottom else np.full(of.shape, 0.5)
        return np.asarray(height * (_ROOM + (1.0 - 2.0 * _ROOM) * share))

    x = width * chosen / max(count - 1, 1)
    level = None if target is None else float(heights(np.array([target.energy]))[0])
    return Plot(np.column_stack([x, heights(values)]), level)


def dashes(length: float, period: float) -> FloatArray:
    """Ends of dashes along a line, as pairs; shape (2 k, )."""
    starts = np.arange(0.0, length, period)
    return np.column_stack([starts, np.minimum(starts + 0.5 * period, length)]).ravel()
