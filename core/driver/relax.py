"""The one driver: `relax` yields the iterates of a relaxation, `minimize` runs it to its end."""

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from ..base import BLAS, COMPONENT, VERTEX_COUNT, CurveError, Message, OptionError, TimeIsUp, TimeLimit, checked
from ..collision import thickness
from ..curve import Curve
from ..descent import Task
from ..io.trajectory import Iterate
from . import moves
from .hand import Hand
from .move import Move, iterates
from .moves.starts import SymmetricStart, Symmetrised
from .options import RelaxOptions
from .outcome import INTERRUPTED, OUT_OF_MEMORY, Outcome, Phase, Result, Status
from .prepare import start_problem
from .run import Relaxation, Run
from .solver import Solver


class WithOutcome:
    """The iterates of a relaxation, with the ``outcome`` that a ``for`` loop would lose: None until the end."""

    @checked
    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self.outcome: Outcome | None = None

    def __iter__(self) -> Iterator[Iterate]:
        self.outcome = yield from self._relaxation


def within(limit: TimeLimit, relaxation: Relaxation) -> Relaxation:
    """The same until the time is up, even in the middle of a step; time between iterates does not count.

    Raises OptionError if it is up before there is a start.
    """
    begun = False
    while True:
        try:
            with limit:
                iterate = next(relaxation)
        except StopIteration as end:
            outcome: Outcome = end.value
            return outcome
        except TimeIsUp as up:
            if up.limit is not limit:
                raise
            if not begun:
                raise OptionError(f"the time limit of {limit.seconds:g} s was up before the start; give more") from None
            reached = Message("stopped at the time limit ({seconds:g} s)", seconds=limit.seconds)
            return Outcome(Status.TIME_LIMIT, (reached,)).noting(up)
        begun = True
        yield iterate


def bounded(work: Relaxation, seconds: float | None, began: float) -> Relaxation:
    """The same with one BLAS thread, and within a time limit, if there is one, since it was begun."""
    work = BLAS.bounding(work)
    return work if seconds is None else within(TimeLimit(seconds, used=time.perf_counter() - began), work)


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
    start, first = task.refined(options.vertices), list[Callable[[Run], Move]]()
    if options.symmetry is not None:
        if task.pins or task.obstacles:
            raise OptionError("pins and obstacles break symmetry; leave them out, or the option")
        symmetrised = Symmetrised.of(start.curve, options.symmetry)
        start, first = replace(start, curve=symmetrised.start), [partial(SymmetricStart, symmetrised=symmetrised)]
    run = begin(start, options)
    run.hand = hand
    return bounded(iterates(run, [*first, *moves.MOVES]), options.time_limit, began)


def begin(start: Task, options: RelaxOptions) -> Run:
    """The run of a refined task; a CurveError says what to do where the curve is too degenerate for it."""
    try:
        return Run(start_problem(start, options), start.curve, options)
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
    return finish(relax(curve, options), Task.of(curve), callback)


def finish(relaxation: Relaxation, task: Task, callback: Callable[[Iterate], None] | None = None) -> Result:
    """Run the relaxation of a task to its end, as `minimize` does; the requested method is the start's."""
    started = time.perf_counter()
    energies: list[float] = []
    fallback: list[int] = []
    last: Iterate | None = None
    given, method = 0, ""  # vertices at the start, and the method that was requested
    meshes: list[tuple[int, int, float]] = []  # vertices, and when the mesh was new: iterate, seconds
    thinnest = math.inf
    run, cut_short = WithOutcome(relaxation), False
    try:
        for last in run:
            given, method = given or len(last.curve), method or last.method
            energies.append(last.energy)
            moves = last.strand_moves
            iterations = last.index - (moves.iterates if moves else 0)
            if not last.path and (moves is None or moves.done):
                meshes.append((len(last.curve), iterations, time.perf_counter() - started if meshes else 0.0))
            if last.method != method:
                fallback.append(last.index)
            if last.radius is not None:
                thinnest = thickness(last.curve, thinnest)
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
    least = thinnest if math.isfinite(thinnest) else None
    return Result(run.outcome, last, tuple(energies), tuple(fallback), seconds, method, task, phases, least)
