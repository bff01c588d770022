"""From one curve to another: both are relaxed, they meet at a common shape, and one way is run backwards."""

import time
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, product

from ..arguments import checked
from ..curve import Curve
from ..curve.alignment import Alignment
from ..deadline import TimeLimit
from ..driver import Iterate, Outcome, Relaxation, RelaxOptions, Result, Status, WithOutcome, finish, relax
from ..driver.loop import within
from ..errors import CurveError, OptionError, counted
from ..messages import OF_GOAL, Message
from ..task import Task
from ..threads import BLAS
from .evidence import NoMotionError, compare
from .meeting import back, images, meeting, on_mesh, renamed

_Joining = Generator[Iterate, None, tuple[Alignment, list[Iterate]]]
MET = "became the other curve: relaxed shapes met, {distance:.2g} radii of gyration apart"
NAMES = ("the first curve", "the second curve")
RENAMED = "in the end components have another order or direction than they were given in"
APART = (
    "no motion was found, though no invariant tells {one} and {other} apart: they come to rest at energies {a:.6g} and "
    "{b:.6g}, in shapes that differ by {distance:.2g} radii of gyration; more hops, or the term bending=0.1, may lead "
    "both to the same shape"
)


@checked
def morph(
    a: Curve | Task,
    b: Curve | Task,
    options: RelaxOptions | None = None,
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Find a motion from one curve to another that is proved free of contact, all along.

    Both are relaxed with the options, to a common shape up to Möbius maps and similarities, which are motions too;
    there the way of ``a`` is joined to that of ``b``, run backwards.  The first iterate is ``a`` and the last one
    ``b``, bit for bit, with its vertices in their order, unless the shapes match only with components in another order
    or run through in opposite directions, which the outcome then says.  Open components are held at their ends, which
    are in the same places in both.  Both avoid the obstacles of ``a``.

    ``callback`` gets every iterate; a `Trajectory` of them all is what `verify` checks.  Raises NoMotionError if
    invariants say that there is no way, or none was found; CurveError or OptionError if the curves cannot be relaxed,
    or do not go together.
    """
    task, wanted = Task.of(a), options or RelaxOptions()
    return finish(morphing((task, Task.of(b)), wanted, NAMES), task, wanted, callback)


def morphing(tasks: Sequence[Task], options: RelaxOptions, names: Sequence[str]) -> Relaxation:
    """Yield the iterates from the first curve over all others to the last one; return how it ended.

    Obstacles are those of the first task; messages use the names of the curves.  Raises as `morph` does.
    """
    work = moving(tasks, options, names)
    compare([each.curve for each in tasks], names)
    return work


def moving(tasks: Sequence[Task], options: RelaxOptions, names: Sequence[str]) -> Relaxation:
    """The same, without looking at invariants."""
    began = time.perf_counter()
    for pair, called in zip(pairwise(tasks), pairwise(names), strict=True):
        check_alike([each.curve for each in pair], called)
    alone = replace(options, time_limit=None, balance=False, hops=0)
    ways = [_Way(*each, tasks[0], alone) for each in zip(names, tasks, strict=True)]
    work = BLAS.bounding(_numbered(_chain(ways, alone, options.hops)))
    if options.time_limit is None:
        return work
    return within(TimeLimit(options.time_limit, used=time.perf_counter() - began), work)


def _chain(ways: "Sequence[_Way]", options: RelaxOptions, hops: int) -> Relaxation:
    found: list[Alignment] = []
    yield from ways[0].iterates
    yield from ways[0].relaxed()
    for here, there in pairwise(ways):
        yield from here.iterates[1:] if found else ()
        deque(there.relaxed(), maxlen=0)
        alignment, joint = yield from _joined(here, there, options, hops)
        there.iterates = [renamed(each, alignment) for each in there.iterates]
        yield from joint
        yield from back(there.iterates)
        found.append(alignment)
    outcome = Outcome(Status.CONVERGED, (Message(MET, distance=max(each.distance for each in found)),))
    return outcome if all(each.as_given for each in found) else outcome.adding(RENAMED)


def _joined(here: "_Way", there: "_Way", options: RelaxOptions, hops: int) -> _Joining:
    """How two shapes align, and the iterates from one to the other; yields those with which the first one goes on.

    Coarse meshes may keep them apart: both continue on equally fine ones, the one of higher energy first, and then hop.
    """
    ways, obstacles = (here, there), here.task.obstacles
    shapes = [images(each.end, obstacles) for each in ways]
    alignment, joint = meeting(shapes[0], shapes[1], obstacles)
    higher = int(there.end.energy > here.end.energy)
    fine = replace(options, mesh="fixed", untangle="never", vertices=max(len(each.end.curve) for each in ways))
    for count, k in product(dict.fromkeys((0, hops)), (higher, 1 - higher)):
        if joint is None:
            further = ways[k].relaxed(replace(fine, hops=count))
            yield from further if k == 0 else ()
            deque(further, maxlen=0)
            shapes[k] = images(ways[k].end, obstacles)
            alignment, joint = meeting(shapes[0], shapes[1], obstacles)
    if joint is None:
        facts = {"one": here.name, "other": there.name, "a": here.end.energy, "b": there.end.energy}
        raise NoMotionError(Message(APART, **facts, distance=alignment.distance))
    return alignment, joint


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

    def __init__(self, name: str, task: Task, first: Task, options: RelaxOptions) -> None:
        if task.pins:
            raise OptionError("a morph holds the ends of open components, and no other vertices; leave pins out")
        if task.obstacles and {each.key for each in task.obstacles} != {each.key for each in first.obstacles}:
            raise OptionError(f"{name} has obstacles of its own; a motion avoids the same ones all along")
        ends = tuple(task.curve.mesh.ends.ravel().tolist())
        self.name, self.task = name, Task(curve=task.curve, obstacles=first.obstacles, pins=ends)
        try:
            self._run = relax(self.task, options)
        except CurveError as error:
            if task is first:
                raise
            raise CurveError(Message(OF_GOAL, goal=name, reason=str(error))) from error  # its place is not the first's
        start = next(self._run)
        self.iterates = [on_mesh(start, task.curve, ends), start][: 1 + (len(start.curve) > len(task.curve))]

    @property
    def end(self) -> Iterate:
        """Where it comes to rest, so far."""
        return self.iterates[-1]

    def relaxed(self, options: RelaxOptions | None = None) -> Iterator[Iterate]:
        """Go on to where it comes to rest, once more if there are options, and yield the iterates."""
        if options is not None:
            self._run = relax(replace(self.task, curve=self.end.curve, pins=self.end.pins), options)
        for iterate in self._run:
            self.iterates.append(iterate)
            yield iterate


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
