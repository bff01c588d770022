"""From one curve to another: both are relaxed, they meet at a common shape, and one way is run backwards.

Before anything moves invariants say whether there is no motion, or that types agree.
"""

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, product

from ..base import OF_GOAL, CurveError, Message, MobiusFlowError, OptionError, checked, counted
from ..curve import Alignment, Curve
from ..descent import Task
from ..io.trajectory import Iterate
from ..knots import knot_type
from ..knots.diagrams import Diagram, alexander, jones, signature, unsigned_linking
from ..knots.exterior import floer
from ..knots.knot_type import bracket_key
from .meeting import Radius, change_mesh, images, meeting, min_radius, rename, run_back
from .options import RelaxOptions
from .outcome import Outcome, Result, Status
from .relax import WithOutcome, bounded, finish, relax
from .run import Relaxation

NAMES = ("the first curve", "the second curve")


class NoMotionError(MobiusFlowError):
    """No motion leads from one curve to another, or none was found; the message says which of the two, and why."""


class DifferentError(NoMotionError):
    """No motion leads from one curve to another."""


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
    are in the same places in both.  Both avoid the obstacles of ``a``.  The curve is a rope all along, as thick as the
    thinner of both; it gives way, and the outcome says so, unless the options give a radius.

    ``callback`` gets every iterate; a `Trajectory` of them all is what `verify` checks.  Raises NoMotionError if
    invariants say that there is no way, or none was found; CurveError or OptionError if the curves cannot be relaxed,
    or do not go together.
    """
    task, wanted = Task.of(a), options or RelaxOptions()
    return finish(morphing((task, Task.of(b)), wanted, NAMES), task, callback)


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
        # both in one space, with as many closed and as many open components, whose ends are in the same places
        (a, b), (one, other) = (each.curve for each in pair), called
        if a.dimension != b.dimension or a.dimension > 3:
            where = "motions are proved in the plane and in space, from one curve to another there"
            raise CurveError(f"{one} is in dimension {a.dimension}, {other} in dimension {b.dimension}; {where}")
        if sorted(a.mesh.closed) != sorted(b.mesh.closed):
            kinds = []
            for name, closed in ((one, a.mesh.closed), (other, b.mesh.closed)):
                parts = [(sum(closed), "closed component"), (len(closed) - sum(closed), "open component")]
                kinds.append(f"{name} is {' and '.join(counted(count, noun) for count, noun in parts if count)}")
            raise CurveError(f"{', '.join(kinds)}; motions neither open, close, join nor divide components")
        if a.mesh.closed != b.mesh.closed:
            order = f"open and closed components have another order in {one} than in {other}"
            raise CurveError(f"{order}; put open ones first in both")
        if (a.vertices[a.mesh.ends] != b.vertices[b.mesh.ends]).any():
            places = f"open components begin or end in other places in {one} than in {other}"
            raise CurveError(f"{places}; move their ends together")
    alone = replace(options, time_limit=None, balance=False, hops=0)
    ways = [_Way(*each, tasks[0], alone) for each in zip(names, tasks, strict=True)]
    return bounded(_number(_chain(ways, alone, options.hops)), options.time_limit, began)


def _chain(ways: "Sequence[_Way]", options: RelaxOptions, hops: int) -> Relaxation:
    """The first way, what joins it to the second one, and that one backwards; so on from there."""
    found, gives_way = list[Alignment](), isinstance(options.radius, str)
    yield from ways[0].iterates
    yield from ways[0].relaxed()
    for first, second in pairwise(ways):
        yield from first.iterates[1:] if found else ()
        deque(second.relaxed(), maxlen=0)
        pair, obstacles = (first, second), first.task.obstacles
        shapes = [images(each.end, obstacles) for each in pair]
        alignment, joint = meeting(shapes[0], shapes[1], obstacles, gives_way)
        # coarse meshes may keep them apart: both go on on equally fine ones, the one of higher energy first, and hop
        higher = int(second.end.energy > first.end.energy)
        fine = replace(options, mesh="fixed", untangle="never", vertices=max(len(each.end.curve) for each in pair))
        for count, k in product(dict.fromkeys((0, hops)), (higher, 1 - higher)):
            if joint is None:
                further = pair[k].relaxed(replace(fine, hops=count))
                yield from further if k == 0 else ()
                deque(further, maxlen=0)
                shapes[k] = images(pair[k].end, obstacles)
                alignment, joint = meeting(shapes[0], shapes[1], obstacles, gives_way)
        if joint is None:
            apart = (
                "no motion was found, though no invariant tells {one} and {other} apart: they come to rest at energies "
                "{a:.6g} and {b:.6g}, in shapes that differ by {distance:.2g} times their size; more hops, a thinner "
                "rope, or the term bending=0.1, may lead both to the same shape"
            )
            facts = {"one": first.name, "other": second.name, "a": first.end.energy, "b": second.end.energy}
            raise NoMotionError(Message(apart, **facts, distance=alignment.distance))
        second.iterates = [rename(each, alignment) for each in second.iterates]
        yield from joint
        yield from run_back(second.iterates)
        found.append(alignment)
    met = "became the other curve: relaxed shapes met, {distance:.2g} times their size apart"
    outcome = Outcome(Status.CONVERGED, (Message(met, distance=max(each.distance for each in found)),))
    if not all(each.as_given for each in found):
        outcome = outcome.adding("in the end components have another order or direction than they were given in")
    threads = [each.name for each in ways if each.iterates[0].radius is None and options.radius == "keep"]
    return outcome.adding("{name} is no rope, as a corner is too sharp", name=threads[0]) if threads else outcome


def _number(work: Relaxation) -> Relaxation:
    """The iterates of several runs as those of one rope, the thinnest so far; the outcome says if it gave way."""
    run, certified, ends, thinnest = WithOutcome(work), True, list[Radius](), None
    for index, iterate in enumerate(run):
        certified &= iterate.certified
        ends = [ends[0] if ends else iterate.radius, iterate.radius]
        thinnest = min_radius(thinnest, iterate.radius) if index else iterate.radius
        yield replace(iterate, index=index, certified=certified, strand_moves=None, radius=thinnest)
    assert run.outcome is not None, "the loop is through"
    one, other = ends
    if one is None or other is None:
        return run.outcome
    if thinnest is None:
        return run.outcome.adding("no way was found for a rope, only for a thread")
    start, end = min(one + other), min(thinnest)
    told = "the rope gave way from radius {start:.3g} to {end:.3g}, as it was in its own way"
    return run.outcome if end == start else run.outcome.adding(told, start=start, end=end)


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
        self.iterates = [change_mesh(start, task.curve, ends), start][: 1 + (len(start.curve) > len(task.curve))]

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


# by whether curves are knots; cheap ones first; those of links do not depend on their orientations
_INVARIANTS: dict[bool, tuple[tuple[Message, Callable[[Diagram], object]], ...]] = {
    True: (
        (Message("signatures {a} and {b}"), signature),
        (Message("Alexander polynomials {a} and {b}"), alexander),
        (Message("different Jones polynomials"), jones),
        (Message("genera {a} and {b}, by knot Floer homology"), lambda knot: (found := floer(knot)) and found.genus),
    ),
    False: (
        (Message("linking numbers {a} and {b}, without signs"), unsigned_linking),
        (Message("different Jones polynomials"), bracket_key),
    ),
}


def compare(curves: Sequence[Curve], names: Sequence[str]) -> Message | None:
    """Say which type all curves have, if that is proved for each; None if it is not, or they have no type.

    Curves in the plane have no type, nor do open components.  Raises DifferentError, with their names, where one curve
    is shown to differ from the next.
    """
    if not all(each.mesh.all_closed and each.dimension == 3 for each in curves):
        return None
    kinds = [knot_type(each) for each in curves]
    for (a, b), called in zip(pairwise(kinds), pairwise(names), strict=True):
        told = None  # the first invariant that differs; those that are not computed are None
        for said, invariant in _INVARIANTS[len(a.diagram.passes) == 1] if a.diagram and b.diagram else ():
            found = [each.diagram and invariant(each.diagram) for each in (a, b)]
            if None not in found and found[0] != found[1]:
                shown = [str(list(each) if isinstance(each, tuple) else each).replace("-", "−") for each in found]
                told = Message(said.template, a=shown[0], b=shown[1])
                break
        if not told and not (a.proved and b.proved and not set(a.names) & set(b.names)):
            continue
        one, other = str(a), str(b)
        mirrored = other == (one[1:] if one.startswith("m") else f"m{one}")
        facts = dict(zip(("one", "other"), called, strict=True))
        if a.names and b.names:
            what = "{one} is {a}, {other} its mirror image {b}" if mirrored else "{one} is {a}, {other} is {b}"
            types = Message(what, **facts, a=one, b=other)
        else:
            types = Message("{one} and {other} are of different types", **facts)
        none = Message("{types}: no motion leads from one to the other", types=types)
        raise DifferentError(Message("{none} ({told})", none=none, told=told) if told else none)
    if not all(each.proved and each.names == kinds[0].names for each in kinds) or len(kinds[0].names) != 1:
        return None
    evidence = ", ".join(dict.fromkeys(each for kind in kinds for each in kind.evidence))
    return Message("both are {type}, by {evidence}", type=str(kinds[0]), evidence=evidence)
