"""Strand moves before the flow, and where it is stuck: what is tangled in a diagram needs no flow to come apart."""

from collections.abc import Iterator

import numpy as np

from ..curve import refine
from ..passes import Untangled, untangled, worth
from ..task import check_refined
from .outcome import Outcome
from .prepare import target_lengths
from .run import Run
from .trajectory import Iterate

ENOUGH = 200  # vertices with which the flow begins, unless the curve had fewer
MANY = 20  # crossings that go, from which on it is worth while before the flow, unless others stay that are as many


class Untangling:
    """The strand moves of one run."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self._found: list[Untangled] = []

    def before_flow(self) -> Iterator[Iterate]:
        """Yield the motions that come first, if they are asked for, or a diagram shows that many crossings go."""
        wanted = self.run.options.untangle
        if wanted == "always" or (wanted == "auto" and self._eligible and self._saves(MANY)):
            yield from self._untangled()

    def where_stuck(self, outcome: Outcome) -> Iterator[Iterate]:
        """Yield motions that lead out of where the flow came to rest, if any are worth while."""
        if self.run.options.untangle != "never" and outcome.may_be_left and self._eligible and self._saves(0):
            yield from self._untangled()

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with what strand moves have achieved."""
        for found in self._found:
            outcome = outcome.adding("strand moves: {reason}", reason=found.reason)
        return outcome

    @property
    def _eligible(self) -> bool:
        """Whether the mesh may change, and the curve is one whose type means something."""
        options, curve = self.run.options, self.run.iterate.curve
        free = options.mesh != "fixed" and isinstance(options.edge_lengths, str) and options.grow == 1.0
        return free and curve.mesh.all_closed and self.run.problem.geometry.prescribes and not self.run.frozen

    def _saves(self, least: int) -> bool:
        """Whether at least so many crossings go, and no more of them stay."""
        gone, left = worth(self.run.iterate.curve, least)
        return gone >= max(least, left, 1)

    def _untangled(self) -> Iterator[Iterate]:
        """Yield all motions, and at last the curve on a mesh for the flow."""
        run = self.run
        first = run.iterate
        stages = untangled(first.curve, np.array(first.pins, dtype=np.intp), run.problem.obstacles, run.options.seed)
        while True:
            try:
                stage = next(stages)
            except StopIteration as end:
                self._found.append(end.value)
                break
            if stage.start.mesh is not run.iterate.curve.mesh:
                yield run.carried(stage.start)
            if stage.path:
                yield run.carried(stage.end, stage.path)
        if run.iterate is not first:
            yield self._refined(min(len(first.curve), ENOUGH))

    def _refined(self, least: int) -> Iterate:
        """The curve reached on a mesh for the flow, in its problem there."""
        run = self.run
        coarse, wanted = run.iterate.curve, run.options.vertices
        fine = refine(coarse, None if wanted is None else max(wanted, len(coarse)))
        fine = fine if wanted or len(fine) >= least else refine(coarse, least)
        check_refined(coarse, fine, run.problem.obstacles)
        pins = run.problem.constraints.pins.on(fine).vertices
        lengths = target_lengths(fine, pins, run.problem.obstacles, run.options)
        return run.restarted(run.problem.on(fine, lengths))
