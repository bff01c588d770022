"""Names of objects in sentences, Blender's words for how runs end, and how long a run will still take."""

import math
import time
from collections.abc import Callable, Sequence

import numpy as np

from ..base import COMPONENT, EDGE, OBSTACLE, OF_GOAL, VERTEX, VERTEX_COUNT, FloatArray, Message
from ..io.trajectory import Iterate
from .moves.rest import ILL_CONDITIONED, MINIMUM, SADDLE
from .options import RelaxOptions
from .outcome import AT_REST, RAISED
from .run import gradient_bound

_SPLINE = "spline {number} of {name}"
_WORDS = {
    AT_REST: Message("converged"),
    EDGE: Message("segment {number}"),
    OBSTACLE: Message("'{name}'"),
    ILL_CONDITIONED: Message("whether the energy is least here cannot be told"),
    MINIMUM: Message("every small change of shape raises the energy"),
    RAISED: Message("points were added on the way, and with more of them the energy is measured higher: {rises}"),
    SADDLE: Message("the energy is not least here (small changes of shape that lower it: {index})"),
    VERTEX: Message("point {number}"),
    VERTEX_COUNT: Message("{count} points"),
}


def named(names: Sequence[str]) -> str:
    """Join names, such as 'A', 'B' and 'C'; of many the first, and how many more there are."""
    *others, last = (f"'{name}'" for name in names)
    if len(others) > 3:
        return Message("{names} and {count} more", names=", ".join(others[:3]), count=len(names) - 3)
    return Message("{names} and {last}", names=", ".join(others), last=last) if others else last


def spline_names(objects: Sequence[str], counts: Sequence[int]) -> list[Message]:
    """Names of all splines of some objects, given how many each object has."""
    return [
        Message(_SPLINE, number=k, name=f"'{name}'")
        for name, count in zip(objects, counts, strict=True)
        for k in range(1, count + 1)
    ]


def in_blenders_words(message: str, splines: Sequence[Message]) -> str:
    """A message of the core in the words of somebody who sees objects; ``splines`` names the components in turn."""

    def word(said: Message) -> Message:
        if said.template == COMPONENT:
            number: int = said.facts["number"]
            return splines[number - 1] if goal is None else Message(_SPLINE, number=number, name=goal)
        return Message(_WORDS[said.template], **said.facts) if said.template in _WORDS else said

    if not isinstance(message, Message):
        return message
    goal = message.facts["goal"] if message.template == OF_GOAL else None
    return (message if goal is None else message.facts["reason"]).reworded(word)


def time_left(seconds: float) -> Message:
    """Say how long something will still take, to one digit."""
    if seconds < 100.0:
        return Message("about {count:.0f} s left", count=float(f"{seconds:.0e}"))
    return Message("about {count:.0f} min left", count=float(f"{seconds / 60:.0e}"))


class TimeLeft:
    """A forecast from the iterates on the present mesh, given only where there is reason to believe it.

    With d = log(gradient / bound) at time t on this mesh, d falls linearly in t where a single slow motion is left,
    and, as a rule, linearly in log t before that.  Both lines are fitted to the later half of the time; the first
    usually ends too early, the second too late; where they roughly agree, the second is the forecast.  At the 1,200
    iterates of seven runs there was a forecast at a fifth of them, right within a factor of two in 7 of 10 cases, or 6
    of 10 without the composite knot.
    """

    def __init__(self, options: RelaxOptions, clock: Callable[[], float] = time.monotonic) -> None:
        self._options, self._clock = options, clock
        self.restart()

    def restart(self) -> None:
        """Forget all iterates: the run was paused, or the curve was dragged."""
        self._vertices, self._index = 0, 0
        self._times: list[float] = []
        self.distances: list[float] = []  # d of the iterates on this mesh

    def add(self, iterate: Iterate) -> None:
        """Note an iterate as it comes."""
        moves = iterate.strand_moves
        if len(iterate.curve) != self._vertices or (moves is not None and not moves.done):
            self.restart()
        bound = gradient_bound(self._options, iterate.curve.mesh, iterate.energy)
        self._vertices, self._index = len(iterate.curve), iterate.index
        self._times.append(self._clock())
        self.distances.append(math.log(max(iterate.gradient_norm / bound, 1.0)) if bound else 0.0)

    @property
    def seconds(self) -> float | None:
        """Seconds left; None where there is no reliable forecast."""
        passed = np.array(self._times) - (self._times or [0.0])[0]
        later = passed >= 0.5 * passed[-1] if len(passed) else passed > 0.0
        t, d = passed[later & (passed > 0.0)], np.array(self.distances)[later & (passed > 0.0)]
        if len(passed) < 12 or len(t) < 8 or t[0] == t[-1]:
            return None
        limit = (self._options.max_iterations - self._index) * (t[-1] - t[0]) / (len(t) - 1)
        soonest, latest = _zero(t, d) - t[-1], math.exp(min(_zero(np.log(t), d), 50.0)) - t[-1]
        # where both forecasts agree up to a factor of two
        left = min(latest, limit) if latest <= 2.0 * soonest < math.inf else math.inf
        return float(left) if 3.0 <= left <= 36_000.0 else None


def _zero(x: FloatArray, d: FloatArray) -> float:
    """Where the line that fits d best is zero; inf if it does not fall."""
    slope, height = np.polyfit(x, d, 1)
    return float(-height / slope) if slope < 0.0 else math.inf
