"""What comes before the first step: the way to the nearest symmetric curve, and a warning of knots that may be lost."""

import logging
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ...base.errors import MobiusFlowError
from ...base.messages import COMPONENT, Message
from ...curve import Curve
from ...descent import Step
from ...descent.step import leg
from ...knots import Effort, knot_type
from ..outcome import Outcome
from ..prepare import target_lengths
from ..run import Change, Move

KEPT = "symmetry {group} was kept, which the start missed by {distance:.2g} times its size"
NONE = "symmetry {group}, so that there was none to keep"
DIRECTIONS = np.array([[3, 1, 2], [-2, 3, 1], [1, -2, 3], [-3, -1, 2], [2, -3, -1]]) / np.sqrt(14)
EFFORT = Effort(vertices=5000, views=3, work=100_000)
_log = logging.getLogger(__name__)


def open_knots(curve: Curve) -> dict[int, str]:
    """The types of open components, by their indices, with their ends joined far out: those of most directions.

    Each is taken by itself.  Trivial ones are left out, and those that are not identified.
    """
    found: dict[int, str] = {}
    for k, (points, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        if closed or curve.dimension != 3 or len(points) < 4:
            continue
        # eight radii of the curve away, where nearly parallel lines lead
        middle = points.mean(axis=0)
        far = 8.0 * np.linalg.norm(points - middle, axis=1).max() * DIRECTIONS
        names = Counter[str]()
        for place in far:
            with suppress(MobiusFlowError):  # an end points there: it is closed along itself
                kind = knot_type(Curve(np.vstack([points, middle + place])), EFFORT)
                names[str(kind) if kind.names else "unknot"] += 1
        name, times = next(iter(names.most_common(1)), ("unknot", 0))
        if 2 * times > len(far) and name != "unknot":
            found[k] = name
    return found


@dataclass(eq=False)
class SymmetricStart(Move):
    """Go from the start to the nearest symmetric curve, whose symmetry is kept from there on."""

    def started(self) -> Change | None:
        run = self.run
        symmetrised = run.symmetrised
        if symmetrised is None or not len(symmetrised.symmetry) or run.iterate.index > 0:
            return None
        way = leg(run.point, run.problem.at_curve(symmetrised.end))
        lengths = target_lengths(symmetrised.mean, run.problem.constraints.pins.vertices, (), run.options)
        point = run.problem.on(symmetrised.mean, lengths, symmetrised.symmetry)
        return Change((Step((way,), 0.0, None),), point, anew=True)

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with a clause about the group."""
        symmetrised = self.run.symmetrised
        if symmetrised is None:
            return outcome
        group = symmetrised.group
        if len(symmetrised.symmetry):
            return outcome.adding(KEPT, group=group.name, distance=group.distance)
        return outcome.adding(NONE, group=group.name)


@dataclass(eq=False)
class OpenKnots(Move):
    """Warn where an open component is knotted and has a free end, and add what became of it."""

    def __post_init__(self) -> None:
        curve, pins = self.run.iterate.curve, set(self.run.iterate.pins)
        self._before, last_ones = open_knots(curve), np.cumsum(curve.mesh.component_sizes)
        for k, name in self._before.items():
            last = int(last_ones[k])
            if not pins >= {last - len(curve.components[k]), last - 1}:
                _log.warning(
                    "component %d is open and knotted (%s, if its ends are joined far away): its ends are free, so "
                    "that it straightens and loses the knot; pin both ends, or close it, to keep the knot",
                    k + 1,
                    name,
                )

    def anew(self) -> "OpenKnots":
        """The same: what the run began with counts."""
        return self

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with a clause for each knot that is lost."""
        after = open_knots(self.run.iterate.curve) if self._before else {}
        for k, name in self._before.items():
            if after.get(k) != name:
                lost = "{component}, which is open, was {type} if its ends are joined far away, and is not any more"
                outcome = outcome.adding(lost, component=Message(COMPONENT, number=k + 1), type=name)
        return outcome
