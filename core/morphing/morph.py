"""From one curve to another: both are relaxed, where they come to the same shape they meet, and one way is run back."""

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, product

from ..arguments import checked
from ..collision import check_clear, check_embedded
from ..curve import Curve
from ..deadline import TimeLimit
from ..driver import Iterate, Outcome, Relaxation, RelaxOptions, Result, Status, WithOutcome, finish, relax
from ..driver.loop import within
from ..errors import CurveError, MobiusFlowError, OptionError, counted
from ..messages import OF_GOAL, Message
from ..task import Task
from ..threads import BLAS
from ..units import check_units
from .alignment import Alignment, Freedom, alignments
from .evidence import difference, type_of
from .meeting import Shape, meeting
from .ways import back, on_mesh, renamed

MET = "the shapes that they relax to met, {distance:.2g} radii of gyration apart"
NAMES = ("the first curve", "the second curve")
RENAMED = "in the end components have another order or direction than they were given in"


class NoMotionError(MobiusFlowError):
    """No motion leads from one curve to another, or none was found; the message says which of the two, and why."""


@checked
def morph(
    a: Curve | Task,
    b: Curve | Task,
    options: RelaxOptions | None = None,
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Find a motion from one curve to another that is proved free of contact, all along.

    Both are relaxed with the options, so that they come to a common shape but for Möbius maps and similarities, which
    are motions too; where one ``b`` is at rest, the other's way is joined to its own, run backwards.  The first iterate
    is ``a`` and the last one ``b``, bit for bit, with its vertices in their order, unless shapes fit only with
    components in another order or run through in opposite directions, which the outcome says then.  Open components
    are held at their ends, which are in the same places in both.  Obstacles are those of ``a``; both avoid them.

    ``callback`` gets every iterate; a `Trajectory` of them all is what `verify` checks.  Raises NoMotionError if
    invariants say that there is no way, or none was found; CurveError or OptionError if the curves cannot be relaxed,
    or do not go together.
    """
    task, wanted = Task.of(a), options or RelaxOptions()
    return finish(morphing((task, Task.of(b)), wanted, NAMES), task, wanted, callback)


def morphing(tasks: Sequence[Task], options: RelaxOptions, names: Sequence[str]) -> Relaxation:
    """Yield the iterates from the first curve over all others to the last one; return how it ended.

    Obstacles are those of the first task; names of the curves are for sentences.  Raises as `morph` does.
    """
    for pair, called in zip(pairwise(tasks), pairwise(names), strict=True):
        check_alike([each.curve for each in pair], called)
    ways = [_Way(*each, tasks[0]) for each in zip(names, tasks, strict=True)]
    work = BLAS.bounding(_numbered(_chain(ways, options)))
    return work if options.time_limit is None else _limited(work, options.time_limit)


def _limited(work: Relaxation, seconds: float) -> Relaxation:
    """The same until the time is up, but for the first curve, which is yielded in any case."""
    began = time.perf_counter()
    yield next(work)
    return (yield from within(TimeLimit(seconds, used=time.perf_counter() - began), work))


def _chain(ways: "Sequence[_Way]", options: RelaxOptions) -> Relaxation:
    kinds = [type_of(each.task.curve) for each in ways]
    for (a, b), called in zip(pairwise(kinds), pairwise(each.name for each in ways), strict=True):
        if a and b and (reason := difference(a, b, called)):
            raise NoMotionError(reason)
    alone = replace(options, time_limit=None, balance=False, hops=0)
    found: list[Alignment] = []
    yield from ways[0].relaxed(alone)
    for here, there in pairwise(ways):
        yield from here.iterates[1:] if found else ()
        deque(there.relaxed(alone), maxlen=0)
        met = meeting(here.shape, there.shape)
        for way in sorted((here, there), key=lambda each: -each.end.energy) if options.hops else ():
            if met is None:
                hops = way.relaxed(replace(alone.at_rest(way.end.curve), hops=options.hops))
                yield from hops if way is here else ()
                deque(hops, maxlen=0)
                met = meeting(here.shape, there.shape)
        if met is None:
            raise NoMotionError(_apart(here, there))
        alignment, joint = met
        there.iterates = [renamed(each, alignment) for each in there.iterates]
        yield from joint
        yield from back(there.iterates)
        found.append(alignment)
    met_at = Message(MET, distance=max(each.distance for each in found))
    outcome = Outcome(Status.CONVERGED, (met_at,))
    return outcome if all(each.as_given for each in found) else outcome.adding(RENAMED)


def _numbered(work: Relaxation) -> Relaxation:
    """The iterates of several runs as those of one."""
    run, certified = WithOutcome(work), True
    for index, iterate in enumerate(run):
        certified &= iterate.certified
        yield replace(iterate, index=index, certified=certified, strand_moves=None)
    assert run.outcome is not None, "the loop is through"
    return run.outcome


class _Way:
    """The way of a curve to where it comes to rest: its iterates, the given curve first."""

    def __init__(self, name: str, task: Task, first: Task) -> None:
        if task.pins:
            raise OptionError("a morph holds the ends of open components, and no other vertices; leave pins out")
        if task.obstacles and {each.key for each in task.obstacles} != {each.key for each in first.obstacles}:
            raise OptionError(f"{name} has obstacles of its own; a motion avoids the same ones all along")
        ends = tuple(task.curve.mesh.ends.ravel().tolist())
        self.name, self.task = name, Task(curve=task.curve, obstacles=first.obstacles, pins=ends)
        self.iterates: list[Iterate] = []
        try:
            check_units(task.curve)
            check_embedded(task.curve)
            check_clear(task.curve, first.obstacles)
        except CurveError as error:
            if task is first:
                raise
            raise CurveError(Message(OF_GOAL, goal=name, reason=str(error))) from error  # its place is not the first's

    @property
    def end(self) -> Iterate:
        """Where it comes to rest, so far."""
        return self.iterates[-1]

    @property
    def shape(self) -> Shape:
        """The curve there, and its images."""
        return Shape(self.end, self.task)

    def relaxed(self, options: RelaxOptions) -> Iterator[Iterate]:
        """Go on from where it ends, and yield what comes there."""
        on = bool(self.iterates)
        task = replace(self.task, curve=self.end.curve, pins=self.end.pins) if on else self.task
        for iterate in relax(task, options):
            new = [iterate]
            if iterate.index == 0:
                given = on_mesh(iterate, task.curve, task.pins)
                new = [] if on else [given, iterate][: 1 + (len(iterate.curve) > len(task.curve))]
            self.iterates += new
            yield from new


def check_alike(curves: Sequence[Curve], names: Sequence[str]) -> None:
    """Raise a CurveError unless two curves are in one space, with the same numbers of closed and of open components.

    Open components have the same ends in both.
    """
    (a, b), (one, other) = curves, names
    if a.dimension != b.dimension or a.dimension > 3:
        where = "motions are proved in the plane and in space, from one curve to another there"
        raise CurveError(f"{one} is in dimension {a.dimension}, {other} in dimension {b.dimension}; {where}")
    if (here := _kind(a)) != (there := _kind(b)):
        kinds = f"{one} is {here}, {other} is {there}"
        raise CurveError(f"{kinds}; motions neither open, close, join nor divide components")
    if a.mesh.closed != b.mesh.closed:
        order = f"open and closed components have another order in {one} than in {other}"
        raise CurveError(f"{order}; put open ones first in both")
    if (a.vertices[a.mesh.ends] != b.vertices[b.mesh.ends]).any():
        places = f"open components begin or end in other places in {one} than in {other}"
        raise CurveError(f"{places}; move their ends together")


def _kind(curve: Curve) -> str:
    closed = sum(curve.mesh.closed)
    parts = [(closed, "closed component"), (len(curve.mesh.closed) - closed, "open component")]
    return " and ".join(counted(count, noun) for count, noun in parts if count)


def _apart(one: _Way, other: _Way) -> Message:
    """Say that shapes do not meet, how much they differ, and what to try."""
    ends = product(one.shape.ways, other.shape.ways)
    apart = min(alignments(a[-1].curve, b[-1].curve, Freedom())[0].distance for a, b in ends)
    facts = {"a": f"{one.end.energy:.6g}", "b": f"{other.end.energy:.6g}", "distance": f"{apart:.2g}"}
    return Message(
        "no motion was found, though no invariant tells {one} and {other} apart: they come to rest at energies {a} and "
        "{b}, in shapes that differ by {distance} radii of gyration; more hops may lead both to the same shape",
        **facts,
        one=one.name,
        other=other.name,
    )
