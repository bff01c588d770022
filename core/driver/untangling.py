"""Strand moves before the flow, and where it is stuck: what a diagram shows as tangled comes apart without any flow."""

import time
from collections.abc import Generator, Hashable, Iterable, Iterator

import numpy as np

from ..collision import check_gap
from ..curve import Curve, refine
from ..curve.pins import arcs, holds
from ..deadline import TimeIsUp
from ..descent import Leg, Point, Step
from ..descent.searches.armijo import on_target
from ..descent.step import attempt
from ..diagrams import QuickInvariants, quick_invariants
from ..errors import MobiusFlowError
from ..messages import Message
from ..passes import Stage, untangled, worth
from ..task import check_refined
from ..types import FloatArray, IntArray
from .outcome import Outcome
from .prepare import target_lengths
from .run import Run
from .trajectory import Iterate, StrandMoves

MANY = 20  # removable crossings from which moves before the flow are worthwhile, unless more crossings stay
ROOM = 50  # iterations to be left where the flow is stuck: with fewer it might end higher
LONGEST, SHORTEST = 0.2, 1e-3  # logarithmic change of lengths in one motion; less is left to the flow
SETTLING = 6  # iterations from one motion to the next
MOST = 2.0  # largest factor by which a move may lengthen an arc between pins: one wound round others may not come back
FAR = 10.0  # lengths of the curve from its middle to the points where ends are joined, in different
WAYS = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
NO_ITERATIONS = Message("none, as there are to be no iterations")
PACKED = Message("none, as what grows between pins or among obstacles is left to the flow")
KNOTTED = Message("others would undo a knot between pinned ends")
STRETCHED = Message("others would stretch the curve between pins")
IN_VAIN = "strands were being moved, but with {left} of {before} crossings left nothing is kept of that"


class Untangling:
    """The strand moves of one run."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self._reasons: list[Message] = []
        self._in_vain: Message | None = None

    def before_flow(self) -> Iterator[Iterate]:
        """Yield the motions before the flow, if they are requested, or a diagram shows that many crossings go.

        With pins the flow comes first: it keeps lengths.
        """
        run, wanted = self.run, self.run.options.untangle
        if run.max_iterations == 0:
            self._reasons += [NO_ITERATIONS] if wanted == "always" else []
        elif run.options.grow != 1.0 and not run.problem.unconfined:
            self._reasons += [PACKED] if wanted == "always" else []
        elif wanted == "always" or (not run.iterate.pins and self._eligible and self._saves(MANY)):
            yield from self._untangled()

    def where_stuck(self, outcome: Outcome) -> Iterator[Iterate]:
        """Yield motions that lead out of where the flow came to rest, if any are worthwhile.

        With pins they have to save more crossings: the lengths that they change come back only step by step.
        """
        least = MANY if self.run.iterate.pins else 0
        if outcome.may_be_left and self.run.iterations_left >= ROOM and self._eligible and self._saves(least):
            yield from self._untangled()

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with clauses about strand moves."""
        for reason in self._reasons:
            outcome = outcome.adding("strand moves: {reason}", reason=reason)
        return outcome

    @property
    def _eligible(self) -> bool:
        """Whether moves are wanted, the mesh may change, and the curve has a type: its ends, if any, are pinned."""
        run, options = self.run, self.run.options
        wanted = options.untangle != "never" and options.may_untangle and options.grow == 1.0
        return wanted and self._ends_are_pinned and run.problem.geometry.prescribes and not run.frozen

    @property
    def _ends_are_pinned(self) -> bool:
        mesh = self.run.iterate.curve.mesh
        return bool(holds(mesh, np.array(self.run.iterate.pins, dtype=np.intp))[mesh.ends].all())

    def _saves(self, least: int) -> bool:
        """Whether at least ``least`` crossings go, and no more stay than go."""
        gone, left = worth(self.run.iterate.curve, least)
        return gone >= max(least, left, 1)

    def _untangled(self) -> Iterator[Iterate]:
        """Yield the motions, then the curve on a mesh for the flow, and motions that restore its lengths."""
        run, first, lengths = self.run, self.run.iterate, _Lengths(self.run)
        self._in_vain = None
        try:
            reason = yield from self._moved(lengths)
        except (MobiusFlowError, np.linalg.LinAlgError) as error:
            reason = Message("stopped where the curve is too degenerate: {error}", error=str(error))
        except (TimeIsUp, KeyboardInterrupt, MemoryError) as stop:
            if run.iterate is first and self._in_vain:
                stop.add_note(self._in_vain)
            raise
        if run.iterate is first:
            self._reasons.append(Message("none are made: {reason}", reason=reason))
            return
        self._reasons.append(reason)
        yield run.restarted(self._refined(lengths, len(first.curve)))
        run.rises.change(first, run.iterate)
        yield from self._restored()

    def _moved(self, lengths: "_Lengths") -> Generator[Iterate, None, Message]:
        """Yield the motions of all moves, down to the fewest crossings; return how they end.

        Nothing is yielded before it is known to be worthwhile: with "auto", until no more crossings are left than gone.
        """
        run, start = self.run, self.run.iterate
        pins = np.array(start.pins, dtype=np.intp)
        held = self._ends_are_pinned and not start.curve.mesh.all_closed
        ways = start.curve.vertices.mean(axis=0) + FAR * start.curve.length * WAYS if held else ()
        knots = _closures(start.curve, ways)
        work = untangled(start.curve, pins, run.problem.obstacles, run.options.seed)
        stages: list[Stage] = []
        refused: Message | None = None
        earlier, least, began = run.strand_moves, None, time.perf_counter()
        while True:
            try:
                stages.append(next(work))
            except StopIteration as stop:
                reason: Message = stop.value.reason
                return refused or reason
            if (seen := stages[-1].seen) is None:
                continue
            if least is None or earlier is None:
                earlier = earlier or StrandMoves(seen.crossings, seen.crossings)
                least = seen.crossings - 1 if run.options.untangle == "always" else seen.crossings // 2
            self._in_vain = Message(IN_VAIN, left=seen.crossings, before=earlier.before)
            if seen.crossings > least:
                continue
            end = stages[-1].end
            refused = STRETCHED if lengths.stretched(end) else KNOTTED if _closures(end, ways) != knots else None
            if refused:
                continue
            point, least, so_far = lengths.point(end), seen.crossings, run.strand_moves or earlier
            spent = so_far.seconds + time.perf_counter() - began
            now = so_far._replace(left=least, moves=earlier.moves + seen.moves, seconds=spent, done=False)
            yield from run.moved(stages, point, now)
            stages, began = [], time.perf_counter()

    def _refined(self, lengths: "_Lengths", least: int) -> Point:
        """The curve reached, on a mesh for the flow, or on its own mesh if the other cannot be computed with."""
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

    def _restored(self) -> Iterator[Iterate]:
        """Yield motions that bring lengths to their targets, as far as these are free, with steps of the flow between.

        The flow alone would lengthen a nearly straight arc only slowly, since that costs energy; motions alone would
        crumple it.
        """
        run, longest = self.run, LONGEST
        while not on_target(run.point) and longest > SHORTEST and run.iterations_left > 0:
            point, share = run.point, min(1.0, longest / run.point.infeasibility)
            try:
                aim = point.vertices - share * point.tangent_space.pseudo_inverse(point.residual)
                found = attempt(point, aim, (1.0 - share) * point.residual, lambda end: bool(end.gradient_norm >= 0.0))
            except np.linalg.LinAlgError:
                return
            if not isinstance(found, Leg):
                longest *= 0.5
                continue
            longest = min(LONGEST, 2.0 * longest)
            for k in range(SETTLING):
                step = run.step() if k else Step((found,), 0.0, None)
                if not isinstance(step, Step) or run.iterations_left <= 0:
                    break
                yield run.accept(step)


def _closures(curve: Curve, ways: Iterable[FloatArray]) -> list[QuickInvariants]:
    """Invariants of a curve with the ends of its arcs joined at a point far away, for several such points.

    Ends are only points, over which a knot slips off: a knot that is there whichever way they go on is the arc's own.
    """
    pairs = list(zip(curve.components, curve.mesh.closed, strict=True))
    joined = ([part if closed else np.vstack([part, way]) for part, closed in pairs] for way in ways)
    return [quick_invariants(Curve.from_components(parts)) for parts in joined]


class _Lengths:
    """Lengths of all arcs between pins and of components without pins, to be restored after strand moves."""

    def __init__(self, run: Run) -> None:
        self._problem = run.problem
        targets = self._problem.units.scale * self._problem.constraints.lengths
        self._of = {place: float(targets[arc].sum()) for place, arc in self._arcs(run.iterate.curve)}

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

    def stretched(self, curve: Curve) -> bool:
        """Whether an arc between pins is much longer than it was."""
        now = ((place, curve.edge_lengths[arc].sum()) for place, arc in self._arcs(curve) if isinstance(place, tuple))
        return any(length > MOST * self._of.get(place, np.inf) for place, length in now)

    def _arcs(self, curve: Curve) -> Iterator[tuple[Hashable, IntArray]]:
        """Each arc, after a key that it has on all meshes: the pin where it begins, or the number of its component."""
        mesh, pins = curve.mesh, self._problem.constraints.pins.on(curve).vertices
        held = holds(mesh, pins)
        for arc in arcs(mesh, pins):
            begins = mesh.tails[arc][held[mesh.tails[arc]]]
            yield tuple(curve.vertices[begins[0]].tolist()) if len(begins) else mesh.component[mesh.tails[arc[0]]], arc
