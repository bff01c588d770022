"""Strand moves where the flow makes no more headway: what a diagram shows as tangled comes apart without any flow."""

import time
from collections import deque
from collections.abc import Generator, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from ...base import FloatArray, IntArray, Message, MobiusFlowError, TimeIsUp
from ...collision import check_gap, walk
from ...curve import Curve, arcs, holds
from ...descent import Leg, Point, Step, attempt, on_target
from ...io.trajectory import Iterate, StrandMoves
from ...knots.closures import closed_far_away
from ...knots.diagrams import QuickInvariants, quick_invariants
from ...untangle import Legs, untangled, worth
from ..move import Change, Move
from ..outcome import Outcome
from ..prepare import target_lengths
from ..run import Run
from .links import shrinking_ball

# directions, of length 1, in which ends are joined far out
WAYS = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]) / np.sqrt(3.0)


@dataclass(eq=False)
class Untangling(Move):
    """Strand moves where the flow comes to rest or makes no headway, though a diagram shows that crossings go.

    If they are requested, they are also made before the flow.
    """

    # crossings that must go from a curve with pins: lengths between them, which moves change, come back step by step
    many: int = 20
    room: int = 50  # iterations to be left: with fewer the flow might end higher
    often: ClassVar[int] = 25  # iterations in which the flow makes no headway unless it lowers the energy
    fall: ClassVar[float] = 0.05  # by this part

    remarks: list[Message] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._given, self._stuck_at = len(self.run.iterate.curve), np.inf  # vertices; energy where strands moved last
        self._in_vain: Message | None = None
        self._energies: deque[float] = deque(maxlen=self.often + 1)  # since the flow's headway was last judged
        self._shares = iter((0.35, 0.15))  # of the crossings that can go, which are left to the flow each time

    def started(self) -> Change | None:
        """Before the flow, if requested."""
        run = self.run
        if run.iterate.index > 0 or run.options.untangle != "always":
            return None
        packed = run.options.grow != 1.0 and not run.problem.unconfined
        if packed or run.max_iterations == 0:
            left = "none, as what grows between pins or among obstacles is left to the flow"
            self._tell(Message(left if packed else "none, as there are to be no iterations"))
            return None
        self._shares = iter(())
        return Change(iterates=self._untangled())

    def stepped(self, step: Step) -> Change | None:
        energies = self._energies
        energies.append(self.run.iterate.energy)
        if len(energies) <= self.often or energies[-1] < (1.0 - self.fall) * energies[0]:
            return None
        energies.clear()
        return self._where_stuck()

    def ended(self, outcome: Outcome) -> Change | None:
        return self._where_stuck() if outcome.may_be_left else None

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with clauses on what became of strand moves."""
        return replace(outcome, clauses=(*outcome.clauses, *self.remarks))

    def _where_stuck(self) -> Change | None:
        """Strand moves, if they are wanted and possible, and at least as many crossings go as stay.

        They change the mesh, and need a knot type to keep: loose ends have none.
        """
        run, curve = self.run, self.run.iterate.curve
        if len(curve) < self._given:
            return None  # the coarse start is over first
        wanted = run.options.untangle != "never" and run.options.may_untangle and run.options.grow == 1.0
        held = run.frozen or run.problem.objective.pull is not None or not run.problem.geometry.prescribes
        if not wanted or held or not self._ends_are_pinned or run.iterations_left < self.room:
            return None
        if not run.iterate.energy < (1.0 - run.headway) * self._stuck_at:
            return None  # the last ones have not helped
        least = self.many if run.iterate.pins else 1
        gone, left = worth(curve, least)
        if gone < max(least, left) or shrinking_ball(run) is not None:
            return None
        return Change(iterates=self._untangled())

    @property
    def _ends_are_pinned(self) -> bool:
        mesh = self.run.iterate.curve.mesh
        return bool(holds(mesh, np.array(self.run.iterate.pins, dtype=np.intp))[mesh.ends].all())

    def _tell(self, reason: str) -> None:
        self.remarks.append(Message("strand moves: {reason}", reason=reason))

    def _untangled(self) -> Iterator[Iterate]:
        """Yield the motions, then the curve with targets for the flow, and motions that restore its lengths."""
        run, first, lengths = self.run, self.run.iterate, _Lengths(self.run)
        self._stuck_at, self._in_vain = first.energy, None
        try:
            reason = yield from self._moved(lengths)
        except (MobiusFlowError, np.linalg.LinAlgError) as error:
            reason = Message("stopped where the curve is too degenerate: {error}", error=str(error))
        except (TimeIsUp, KeyboardInterrupt, MemoryError) as stop:
            if run.iterate is first and self._in_vain:
                stop.add_note(self._in_vain)
            raise
        if run.iterate is first:
            self._tell(Message("none are made: {reason}", reason=reason))
            return
        self._tell(reason)
        curve, pins = run.iterate.curve, np.array(run.iterate.pins, dtype=np.intp)
        point = lengths.point(curve, target_lengths(curve, pins, run.problem.obstacles, run.options))
        run.restart()
        run.charged -= 1
        if run.strand_moves:
            run.strand_moves = run.strand_moves._replace(iterates=run.strand_moves.iterates + 1, done=True)
        yield run.go(point)
        run.rises.change(first, run.iterate)
        yield from self._restored()

    def _moved(self, lengths: "_Lengths") -> Generator[Iterate, None, str]:
        """Yield the motions of all moves, down to the fewest crossings; return how they end.

        Nothing is yielded before it is known to be worthwhile: with "auto", until no more crossings are left than gone.
        """
        run, start = self.run, self.run.iterate
        pins = np.array(start.pins, dtype=np.intp)
        held = self._ends_are_pinned and not start.curve.mesh.all_closed
        ways = WAYS.tolist() if held else ()
        knots = _closures(start.curve, ways)
        given = run.problem.obstacles, run.problem.radius, run.options.seed, next(self._shares, 0.0)
        work = untangled(start.curve, pins, *given)
        stages: list[Legs] = []
        refused: Message | None = None
        earlier, least, began = run.strand_moves, None, time.perf_counter()
        while True:
            try:
                stages.append(next(work))
            except StopIteration as stop:
                reason: str = stop.value
                return refused or reason
            seen = stages[-1]
            if least is None or earlier is None:
                earlier = earlier or StrandMoves(seen.crossings, seen.crossings)
                least = seen.crossings - 1 if run.options.untangle == "always" else seen.crossings // 2
            in_vain = "strands were being moved, but with {left} of {before} crossings left nothing is kept of that"
            self._in_vain = Message(in_vain, left=seen.crossings, before=earlier.before)
            if seen.crossings > least:
                continue
            end = seen.end
            if lengths.stretched(end):
                refused = Message("others would stretch the curve between pins")
                continue
            if _closures(end, ways) != knots:
                refused = Message("others would undo a knot between pinned ends")
                continue
            refused = None
            point, least, so_far = lengths.point(end), seen.crossings, run.strand_moves or earlier
            spent = so_far.seconds + time.perf_counter() - began
            now = so_far._replace(left=least, moves=earlier.moves + seen.moves, seconds=spent, done=False)
            # along the stages, to a point of the problem at their end; what comes before is described as that end is
            mesh, run.point = run.iterate.curve.mesh, point
            there = run.described(run.iterate.index)
            frames: list[tuple[Curve, tuple[FloatArray, ...]]] = []
            for stage in stages:
                frames += [(stage.start, ())] * (stage.start.mesh is not mesh)
                frames += [(stage.start.with_vertices(end), (end,)) for end in stage.path]
                mesh = stage.start.mesh
            for made, (curve, path) in enumerate(frames, now.iterates + 1):
                run.charged -= 1
                run.strand_moves = now._replace(iterates=made)  # so far, for the run may be interrupted here
                pinned = tuple(point.problem.constraints.pins.on(curve).vertices.tolist())
                each = replace(there, curve=curve, path=path, pins=pinned, strand_moves=run.strand_moves)
                run.iterate = replace(each, index=run.iterate.index + 1)
                yield run.iterate
            stages, began = [], time.perf_counter()

    def _restored(self) -> Iterator[Iterate]:
        """Yield motions that bring lengths to their targets, as far as these are free, with steps of the flow between.

        The flow alone would lengthen a nearly straight arc only slowly, since that costs energy; motions alone would
        crumple it.
        """
        run = self.run

        def restored(_: float, stride: float) -> Leg | None:
            point = run.point
            share = min(1.0, stride / point.infeasibility)
            aim = point.vertices - share * point.tangent_space.pseudo_inverse(point.residual)
            found = attempt(point, aim, (1.0 - share) * point.residual, lambda end: bool(end.gradient_norm >= 0.0))
            return found if isinstance(found, Leg) else None

        # logarithmic changes of lengths in one motion; less is left to the flow
        legs = walk(restored, np.inf, 0.2, 1e-3)
        while not on_target(run.point) and run.iterations_left > 0:
            try:
                _, found = next(legs)
            except (StopIteration, np.linalg.LinAlgError):
                return
            # iterations from one motion to the next
            for k in range(6):
                step = run.step() if k else Step((found,), 0.0, None)
                if not isinstance(step, Step) or run.iterations_left <= 0:
                    break
                yield run.accept(step)


def _closures(curve: Curve, ways: Iterable[Sequence[float]]) -> list[QuickInvariants]:
    """Invariants of a curve with the ends of its arcs joined far out, in several directions.

    Ends are only points, over which a knot slips off: a knot that is there whichever way they go on is the arc's own.
    """
    return [quick_invariants(closed_far_away(curve, (x, y, z))) for x, y, z in ways]


class _Lengths:
    """Lengths of all arcs between pins and of components without pins, to be restored after strand moves."""

    def __init__(self, run: Run) -> None:
        self._problem = run.problem.as_rope(run.problem.radius)  # again, if it has let go
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
        # an arc may become twice as long: one wound round others more often may not come back
        return any(length > 2.0 * self._of.get(place, np.inf) for place, length in now)

    def _arcs(self, curve: Curve) -> Iterator[tuple[Hashable, IntArray]]:
        """Each arc, after a key that it has on all meshes: the pin where it begins, or the number of its component."""
        mesh, pins = curve.mesh, self._problem.constraints.pins.on(curve).vertices
        held = holds(mesh, pins)
        for arc in arcs(mesh, pins):
            begins = mesh.tails[arc][held[mesh.tails[arc]]]
            yield tuple(curve.vertices[begins[0]].tolist()) if len(begins) else mesh.component[mesh.tails[arc[0]]], arc
