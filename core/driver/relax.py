"""The one driver: `relax` yields the iterates of a relaxation, `minimize` runs it to its end."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ..base.arguments import checked, checked_fields
from ..base.deadline import TimeLimit
from ..base.errors import CurveError, OptionError, counted
from ..base.messages import COMPONENT, VERTEX_COUNT, Message
from ..base.threads import BLAS
from ..curve import Curve
from ..curve.refine import halved
from ..descent.task import Task, centred
from ..energies.hierarchy import moebius_energy
from ..io.trajectory import Iterate
from . import moves
from .hand import Hand
from .options import RelaxOptions
from .outcome import INTERRUPTED, OUT_OF_MEMORY, Outcome, Status
from .prepare import Symmetrised, start_problem
from .run import Relaxation, Run, WithOutcome, iterates, within
from .solver import Solver


@checked_fields
@dataclass(frozen=True)
class Phase:
    """The cost of a relaxation on one mesh, including the change to the next one; wall-clock seconds."""

    vertices: int
    iterations: int
    seconds: float


@checked_fields
@dataclass(frozen=True, eq=False)
class Result:
    """How a relaxation ended, and where.

    - ``outcome``: why it ended.
    - ``last``: the last iterate.
    - ``energies``: the objective at every iterate, the start first.
    - ``fallback_steps``: iterates reached by the fallback method.
    - ``seconds``: wall-clock time.
    - ``method``: name of the requested method.
    - ``task``: the task that was to be relaxed.
    - ``phases``: the relaxation on each mesh, in order.
    """

    outcome: Outcome
    last: Iterate
    energies: tuple[float, ...]
    fallback_steps: tuple[int, ...]
    seconds: float
    method: str
    task: Task
    phases: tuple[Phase, ...] = ()

    def __repr__(self) -> str:
        after = counted(self.iterations, "iteration")
        proved = "certified" if self.certified else "not certified"
        return f"<Result: {self.status.value} after {after}, objective {self.energies[-1]:.9g}, {proved}, {self.curve}>"

    @property
    def curve(self) -> Curve:
        """The last curve, in the user's units."""
        return self.last.curve

    @property
    def status(self) -> Status:
        """Why it ended."""
        return self.outcome.status

    @property
    def message(self) -> str:
        """The same in a sentence."""
        return self.outcome.message

    @property
    def certified(self) -> bool:
        """Whether every motion from the (refined) start to the result was proved free of contact."""
        return self.last.certified

    @property
    def iterations(self) -> int:
        """The number of iterates after the start, without those of strand moves."""
        moves = self.last.strand_moves
        return len(self.energies) - 1 - (moves.iterates if moves else 0)

    @property
    def final_energy(self) -> float:
        """The Möbius energy of the last curve, without the objective's other terms: as in ``mobius-flow energy``."""
        return self._final_energy[0]

    @property
    def final_energy_error(self) -> float:
        """A bound on its relative error, from a sample: 0 up to 30,000 vertices, where the energy is exact."""
        return self._final_energy[1]

    @cached_property
    def _final_energy(self) -> tuple[float, float]:
        return moebius_energy(centred(self.curve))

    @cached_property
    def mesh_error(self) -> float | None:
        """About how much the final energy differs from that of the smooth curve through the vertices, in its units.

        Halving all edges along splines removes three quarters of it.  None for open and for large curves.
        """
        # more vertices take more than a second
        if not self.curve.mesh.all_closed or len(self.curve) > 3000:
            return None
        return abs(self.final_energy - moebius_energy(centred(halved(self.curve)))[0]) / 0.75

    def show(self) -> Any:
        """The result as a figure that can be turned, with the objective beside it; notebooks display it.

        Raises MobiusFlowError if Plotly is not installed, CurveError if the curve is not in the plane or in space.
        """
        from ..keys.view import figure, still  # pictures are made of results, not the other way round

        return figure(still(self.curve, self.energies), title=f"Möbius energy {self.final_energy:.6g}")

    def report(self) -> dict[str, object]:
        """The result as the plain values that ``--report`` writes."""
        errors = self.outcome.sampled_errors
        return {
            "status": self.status.value,
            "message": self.message,
            "iterations": self.iterations,
            "seconds": self.seconds,
            "phases": [asdict(phase) for phase in self.phases],
            "energy": list(self.energies),
            "final_energy": self.final_energy,
            "final_energy_error": self.final_energy_error,
            "vertices": len(self.curve),
            "components": len(self.curve.mesh.component_sizes),
            "pins": list(self.last.pins),
            "symmetry": self.last.symmetry or None,
            "obstacles": len(self.task.obstacles),
            "grown": self.last.grown,
            "max_edge_length_error": self.last.edge_length_error,
            "certified": self.certified,
            "method": self.method,
            "fallback_steps": list(self.fallback_steps),
            "negative_eigenvalues": self.outcome.negative_eigenvalues,
            "symmetric_negative_eigenvalues": self.outcome.symmetric_negative_eigenvalues,
            "sampled_errors": None if errors is None else asdict(errors),
            "strand_moves": self.last.strand_moves and self.last.strand_moves.report(),
        }


@checked
@BLAS.bounded()
def relax(curve: Curve | Task, options: RelaxOptions | None = None, hand: Hand | None = None) -> Relaxation:
    """Relax a curve: yield it refined, then the end of every accepted step; return how it ended.

    In a ``for`` loop the `Outcome` is lost: take it from ``outcome = yield from relax(…)``, from `WithOutcome`, or from
    `minimize`.  BLAS runs with one thread while this computes, and as the caller set it between iterates.

    The curve is an embedded polygon, in any units and place, or a `Task`: one with obstacles and pins.  A ``hand`` may
    drag it meanwhile.  Raises CurveError if it touches itself or an obstacle, or is degenerate; the message says where.
    Raises OptionError if options contradict the task or each other.
    """
    began = time.perf_counter()
    options = RelaxOptions() if options is None else options
    task = Task.of(curve)
    Solver(options).check_size(task.curve)
    start, symmetrised = task.refined(options.vertices), None
    if options.symmetry is not None:
        if task.pins or task.obstacles:
            raise OptionError("pins and obstacles break symmetry; leave them out, or the option")
        symmetrised = Symmetrised.of(start.curve, options.symmetry)
        start = replace(start, curve=symmetrised.start)
    work = BLAS.bounding(iterates(begin(start, options, hand, symmetrised), moves.MOVES))
    if options.time_limit is None:
        return work
    return within(TimeLimit(options.time_limit, used=time.perf_counter() - began), work)


def begin(start: Task, options: RelaxOptions, hand: Hand | None = None, symmetrised: Symmetrised | None = None) -> Run:
    """The run of a refined task; a CurveError says what to do where the curve is too degenerate for it."""
    try:
        return Run(start_problem(start, options), start.curve, options, None, hand, symmetrised)
    except np.linalg.LinAlgError as error:
        lengths = start.curve.component_lengths
        shortest, width = int(lengths.argmin()), float(np.ptp(start.curve.vertices, axis=0).max())
        # so much wider than a component is long, the link explains a singular matrix
        if width >= 100.0 * lengths[shortest]:
            small = (
                "{component} is only {length:.3g} long in a link {width:.3g} wide, too small or too far away to be "
                "relaxed together with the rest: relax it by itself, or move or scale it"
            )
            component = Message(COMPONENT, number=shortest + 1)
            remedy = Message(small, component=component, length=float(lengths[shortest]), width=width)
        elif options.terms:
            remedy = Message("give terms smaller weights, or move close strands apart")
        else:
            remedy = Message("move close strands apart")
        degenerate = "the curve is too degenerate to be relaxed: {error}; {remedy}"
        raise CurveError(Message(degenerate, error=str(error), remedy=remedy)) from error


@checked
def minimize(
    curve: Curve | Task, options: RelaxOptions | None = None, callback: Callable[[Iterate], None] | None = None
) -> Result:
    """Relax a curve to the end and return the result.

    After a keyboard interrupt, or if memory runs out, the result is the curve reached so far.  ``callback`` gets every
    iterate, unless an interrupt cuts it short.  Raises as `relax` does.
    """
    return finish(relax(curve, options), Task.of(curve), options or RelaxOptions(), callback)


def finish(
    relaxation: Relaxation, task: Task, options: RelaxOptions, callback: Callable[[Iterate], None] | None = None
) -> Result:
    """Run the relaxation of a task with some options to its end, as `minimize` does."""
    started = time.perf_counter()
    energies: list[float] = []
    fallback: list[int] = []
    last: Iterate | None = None
    given = 0  # vertices at the start
    meshes: list[tuple[int, int, float]] = []  # vertices, and when the mesh was new: iterate, seconds
    run, cut_short = WithOutcome(relaxation), False
    try:
        for last in run:
            given = given or len(last.curve)
            energies.append(last.energy)
            moves = last.strand_moves
            iterations = last.index - (moves.iterates if moves else 0)
            if not last.path and (moves is None or moves.done):
                meshes.append((len(last.curve), iterations, time.perf_counter() - started if meshes else 0.0))
            if last.method != options.method:
                fallback.append(last.index)
            if callback is not None:
                callback(last)
    except (KeyboardInterrupt, MemoryError) as error:
        if last is None:
            raise
        run.outcome = (OUT_OF_MEMORY if isinstance(error, MemoryError) else INTERRUPTED).noting(error)
        cut_short = True
    assert last is not None, "relax yields at least its start"
    assert run.outcome is not None, "the loop is through"
    cut_short |= run.outcome.status is Status.TIME_LIMIT
    if cut_short and moves and not moves.done:
        under_way = "strands were being moved, and {left} of {before} crossings are left"
        run.outcome = run.outcome.adding(under_way, left=moves.left, before=moves.before)
    elif cut_short and len(last.curve) < given:
        fewer = Message(VERTEX_COUNT, count=len(last.curve))
        run.outcome = run.outcome.adding("it has {vertices}, {given} at the start", vertices=fewer, given=given)
    seconds = time.perf_counter() - started
    ends = pairwise([*meshes, (0, iterations, seconds)])
    phases = tuple(Phase(size, end - begun, until - since) for (size, begun, since), (_, end, until) in ends)
    return Result(run.outcome, last, tuple(energies), tuple(fallback), seconds, options.method, task, phases)
