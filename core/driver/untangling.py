"""Strand moves before the flow, and where it is stuck: what is tangled in a diagram needs no flow to come apart."""

import time
from collections.abc import Generator, Hashable, Iterator

import numpy as np

from ..collision import check_gap
from ..curve import Curve, refine
from ..curve.pins import arcs, holds
from ..descent import Point
from ..errors import MobiusFlowError
from ..messages import Message
from ..passes import Seen, Stage, Untangled, untangled, worth
from ..task import check_refined
from ..types import FloatArray, IntArray
from .outcome import Outcome
from .prepare import target_lengths
from .run import Run
from .trajectory import Iterate, StrandMoves

MANY = 20  # crossings that go, from which on it is worth while before the flow, unless others stay that are as many
ROOM = 50  # iterations left where the flow is stuck, with fewer of which it might end higher
NO_ITERATIONS = Message("none, as there are to be no iterations")


class Untangling:
    """The strand moves of one run."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self._reasons: list[Message] = []

    def before_flow(self) -> Iterator[Iterate]:
        """Yield the motions that come first, if they are asked for, or a diagram shows that many crossings go."""
        run, wanted = self.run, self.run.options.untangle
        if run.max_iterations == 0:
            self._reasons += [NO_ITERATIONS] if wanted == "always" else []
        elif wanted == "always" or (self._eligible and self._saves(MANY)):
            yield from self._untangled()

    def where_stuck(self, outcome: Outcome) -> Iterator[Iterate]:
        """Yield motions that lead out of where the flow came to rest, if any are worth while."""
        if outcome.may_be_left and self.run.iterations_left >= ROOM and self._eligible and self._saves(0):
            yield from self._untangled()

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with what strand moves have achieved."""
        for reason in self._reasons:
            outcome = outcome.adding("strand moves: {reason}", reason=reason)
        return outcome

    @property
    def _eligible(self) -> bool:
        """Whether moves are wanted, the mesh may change, and the curve has a type: its ends, if any, are pinned."""
        run, options = self.run, self.run.options
        if options.untangle == "never" or not options.may_untangle or options.grow != 1.0 or run.frozen:
            return False
        typed = holds(run.problem.mesh, run.problem.constraints.pins.vertices)[run.problem.mesh.ends].all()
        return bool(typed) and run.problem.geometry.prescribes

    def _saves(self, least: int) -> bool:
        """Whether at least so many crossings go, and no more of them stay."""
        gone, left = worth(self.run.iterate.curve, least)
        return gone >= max(least, left, 1)

    def _untangled(self) -> Iterator[Iterate]:
        """Yield all motions, and at last the curve on a mesh for the flow."""
        run, first, lengths = self.run, self.run.iterate, _Lengths(self.run)
        pins = np.array(first.pins, dtype=np.intp)
        work = _by_moves(untangled(first.curve, pins, run.problem.obstacles, run.options.seed))
        earlier = run.strand_moves.moves if run.strand_moves else 0
        try:
            while True:
                began = time.perf_counter()
                stages, seen = next(work)
                point = lengths.point(stages[-1].end)
                so_far = run.strand_moves or StrandMoves(seen.crossings, seen.crossings)
                spent = so_far.seconds + time.perf_counter() - began
                now = so_far._replace(left=seen.crossings, moves=earlier + seen.moves, seconds=spent, done=False)
                yield from run.moved(stages, point, now)
        except StopIteration as end:
            self._reasons.append(end.value)
        except (MobiusFlowError, np.linalg.LinAlgError) as error:
            self._reasons.append(Message("stopped where the curve is too degenerate: {error}", error=str(error)))
        if run.iterate is not first:
            yield run.restarted(self._refined(lengths, len(first.curve)))
            run.rises.change(first, run.iterate)

    def _refined(self, lengths: "_Lengths", least: int) -> Point:
        """The curve reached on a mesh for the flow, or on its own where that cannot be computed with."""
        run = self.run
        coarse, wanted = run.iterate.curve, run.options.vertices
        try:
            fine = refine(coarse, None if wanted is None else max(wanted, len(coarse)))
            fine = fine if wanted or len(fine) >= least else refine(coarse, least)
            check_refined(coarse, fine, run.problem.obstacles)
            pins = run.problem.constraints.pins.on(fine).vertices
            return lengths.point(fine, target_lengths(fine, pins, run.problem.obstacles, run.options))
        except (MobiusFlowError, np.linalg.LinAlgError):
            return run.point


def _by_moves(work: Generator[Stage, None, Untangled]) -> Generator[tuple[list[Stage], Seen], None, Message]:
    """The stages of each move, and what is seen after it; return how they end."""
    stages: list[Stage] = []
    while True:
        try:
            stages.append(next(work))
        except StopIteration as end:
            reason: Message = end.value.reason
            return reason
        if (seen := stages[-1].seen) is not None:
            yield stages, seen
            stages = []


class _Lengths:
    """Those of all arcs between pins and of components without, which strand moves change and the flow restores."""

    def __init__(self, run: Run) -> None:
        self._problem, curve = run.problem, run.iterate.curve
        targets = self._problem.units.scale * self._problem.constraints.lengths
        self._of = {place: float(targets[arc].sum()) for place, arc in self._arcs(curve)}

    def point(self, curve: Curve, wanted: FloatArray | None = None) -> Point:
        """The point of a curve, with targets in proportion to ``wanted``, shape (edges,), by default its own lengths.

        Raises CurveError or LinAlgError where neither energy nor gradient can be computed.
        """
        check_gap(curve)
        lengths = np.array(curve.edge_lengths if wanted is None else wanted)
        for place, arc in self._arcs(curve):
            if len(arc) > 1 and place in self._of:
                lengths[arc] *= self._of[place] / lengths[arc].sum()
        point = self._problem.on(curve, lengths)
        point.gradient_norm  # noqa: B018 (computed here, where its failure can be met)
        return point

    def _arcs(self, curve: Curve) -> Iterator[tuple[Hashable, IntArray]]:
        """Each with what it has on all meshes: the pin where it begins, or the number of its component."""
        mesh, pins = curve.mesh, self._problem.constraints.pins.on(curve).vertices
        held = holds(mesh, pins)
        for arc in arcs(mesh, pins):
            begins = mesh.tails[arc][held[mesh.tails[arc]]]
            yield tuple(curve.vertices[begins[0]].tolist()) if len(begins) else mesh.component[mesh.tails[arc[0]]], arc
