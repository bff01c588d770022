"""Ropes where curves were: moved as little as their radii allow, every motion proved that of ropes.

Centre lines that meet are led apart first.  Ropes are as thin at first as that leaves room for; the share of their
radii that is kept then follows the room that steps make.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import MISSING, dataclass
from typing import Any

import numpy as np

from ..base import COMPONENT, CurveError, Message, OptionError, Place, checked
from ..base.arguments import check_options, option
from ..collision import check_clear, check_embedded, is_free, rope_motion, written
from ..curve import Curve, Pins, at_edges, bending_radii, holds, subdivide
from ..descent.task import Task, check_units
from ..driver import Outcome, Relaxation, Result, Status, finish
from ..driver.options import are_radii, radii, time_limit
from ..driver.outcome import stalled
from ..driver.relax import bounded
from ..io.trajectory import Iterate
from .crossings import AXES, Crossing, lead_apart
from .displacement import Ropes

LENGTHS = ("free", "keep")
KEPT = 1e-3  # part by which kept lengths may differ at the end; ten times as much while ropes grow


@dataclass(frozen=True, kw_only=True)
class SeparateOptions:
    """How curves become ropes."""

    radius: Sequence[float] | float = option(
        MISSING,
        "Radius",
        "radius of the ropes, one or one for each component with commas between",
        objects=("a number above 0, or one for each component", are_radii),
        read=radii,
        metavar="R,R,…",
    )
    over: str | None = option(
        None,
        "Over",
        "axis on whose side the later of two curves that meet goes over",
        automatic="the direction in which they extend least there",
        choices=tuple(AXES),
        metavar="AXIS",
    )
    lengths: str = option("free", "Lengths", "whether edges may change their lengths", choices=LENGTHS, metavar="L")
    free_ends: bool = option(False, "Free Ends", "hold the ends of open curves only where they are pins")
    time_limit: float | None = time_limit()

    def __post_init__(self) -> None:
        check_options(self)
        object.__setattr__(self, "radius", tuple(map(float, np.ravel(self.radius))))


@dataclass(frozen=True)
class Separated(Outcome):
    """How a separation ended.

    - ``share``: of the radii that was reached: 1 where there was room.
    - ``crossings``: centre lines that met at the start, and who went over whom.
    - ``moved``: how far any vertex has moved from the given curve.
    """

    share: float = 0.0
    crossings: tuple[Crossing, ...] = ()
    moved: float = 0.0


@checked
def separate(
    curve: Curve | Task,
    radius: float | Sequence[float],
    *,
    over: str | None = None,
    lengths: str = "free",
    free_ends: bool = False,
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Make ropes of curves that are nearer than their radii, touch, or run through each other; see the module.

    ``radius`` is one number, or one for each component.  Pins stay in place, ends too unless they are free.  Where
    centre lines meet, the later one goes over, as seen from the axis ``over`` (x, y, z, -x, -y or -z; by default that
    in which they extend least where they meet); from the first curve without such places on every motion is proved to
    be that of ropes.  ``lengths``: free, or keep, those of all edges.

    The result's outcome is a `Separated`.  If there is less room it is stalled, with the place where it is tight, and
    the curve is the best that was reached.  Raises CurveError if the curve cannot be led apart where it meets itself,
    or touches an obstacle; OptionError for wrong values.
    """
    options = SeparateOptions(radius=radius, over=over, lengths=lengths, free_ends=free_ends)
    task = Task.of(curve)
    return finish(separating(task, options), task, callback)


def separating(task: Task, options: SeparateOptions) -> Relaxation:
    """Yield the iterates of a separation; return how it ended, a `Separated`.  Raises as `separate` does."""
    return bounded(_iterates(task, options), options.time_limit, time.perf_counter())


def _iterates(task: Task, options: SeparateOptions) -> Relaxation:
    """The given curve, if it is embedded, the first one whose centre lines do not meet, and the ropes from there on."""
    curve = task.curve
    check_units(curve)
    if curve.dimension != 3:
        raise CurveError(f"the curve has dimension {curve.dimension}; ropes are separated in space")
    radius, parts = np.array(options.radius), len(curve.mesh.component_sizes)
    if len(radius) not in (1, parts):
        raise OptionError(f"radius has {len(radius)} numbers for {parts} components; give one, or one for each")
    size = float(np.abs(curve.vertices).max())
    if not 1e-6 * size < radius.min() <= radius.max() < 1e2 * size:  # thinner ones cannot be proved
        worst = radius.min() if radius.min() <= 1e-6 * size else radius.max()
        allowed = f"{1e-6 * size:g} to {1e2 * size:g}"
        raise OptionError(f"the tube's radius is {worst:g}, but coordinates are up to {size:g}; give {allowed}")
    if not (curve.edge_lengths.min() > 0.0 and bending_radii(curve).min() > 1e-9 * radius.min()):
        check_embedded(curve)  # which says where it doubles back
    check_clear(curve, task.obstacles)
    radius = np.broadcast_to(radius, parts).copy()
    # three radii: edges bend around what is in their way; of very thin ropes 4,000, or there would be too many
    longest = np.maximum(3.0 * radius[curve.mesh.edge_component], curve.length / 4000)
    pieces = np.ceil(curve.edge_lengths / longest).astype(np.intp)
    given, curve = curve.mesh, subdivide(curve, pieces)
    mesh, now = curve.mesh, np.empty(given.size, dtype=np.intp)  # the numbers of the given vertices
    now[given.tails], now[given.ends[:, 1]] = mesh.tails[np.cumsum(pieces) - pieces], mesh.ends[:, 1]
    ends, keep = () if options.free_ends else mesh.ends.ravel(), options.lengths == "keep"
    pins = np.unique(np.array([*now[list(task.pins)], *ends], dtype=np.intp))
    if task.pin_tangents:
        pins = np.unique([pins, mesh.heads[mesh.outgoing[pins]], mesh.tails[mesh.incoming[pins]]])
    held = holds(mesh, Pins.of(curve, pins).vertices if keep else pins)  # taut arcs whose lengths are kept cannot move
    taut = held & ~holds(mesh, pins)
    ropes = Ropes(curve, radius, held, task.obstacles, keep)
    try:
        apart, crossings = lead_apart(curve, radius, ropes.stiffness, held, taut, options.over, task.obstacles)
    except CurveError as error:
        assert error.place is not None  # noqa: PT017 (it is about vertices)
        drawn = np.flatnonzero(np.isin(now, error.place.vertices)).tolist()  # of the given curve
        raise CurveError(error.args[0], Place(tuple(drawn), error.place.position)) from None
    led = curve.with_vertices(apart)
    try:
        check_embedded(led)
        check_clear(led, task.obstacles)
    except CurveError as error:  # about edges that nobody has drawn
        assert error.place is not None  # noqa: PT017 (it names edges)
        where = error.place.position
        cannot = Message("strands cannot be led apart near {place}; move them there", place=written(np.array(where)))
        raise CurveError(cannot, Place((), where)) from error
    if crossings or np.array_equal(apart, curve.vertices):
        return (yield from _separated(ropes, led, 0, tuple(crossings)))
    yield ropes.iterate(0, curve)
    if not is_free(mesh, curve.vertices, apart, task.obstacles):
        raise CurveError("strands are too near to each other to be led apart with a proof; move them apart")
    return (yield from _separated(ropes, led, 1, ()))


def _separated(ropes: Ropes, now: Curve, index: int, crossings: tuple[Crossing, ...]) -> Relaxation:
    """The iterates from an embedded curve to ropes at rest."""

    def steps(most: int, least: float) -> Iterator[Iterate]:
        """So many steps, up to a decrement of a part of the quadratic form."""
        nonlocal now, index
        for _ in range(most):
            end, size, decrement = ropes.step(now)
            if end is None or decrement <= least * ropes.energy(now):
                break
            now, index = end, index + 1
            yield ropes.iterate(index, now, size, decrement)
        if ropes.keep:  # multipliers take over the tension of kept lengths
            ropes.pull = ropes.stretches(now)[1]

    shares = list[float]()
    while len(shares) < 12 or ropes.share > 1.01 * shares[-12]:
        room, kept = ropes.room(now), ropes.length_error(now) <= 10.0 * KEPT
        if room > ropes.most and ropes.share > 0.85 * ropes.most and kept:
            break
        if kept:  # steps double little gaps, so that they have more to do the less room there is
            ropes.thicken(now, room * (0.5 + 0.4 * min(room, 1.0)))
        if not shares:
            yield ropes.iterate(index, now)
            if not ropes.share:
                return _outcome(ropes, now, crossings)
        elif ropes.share < 1.03 * shares[-1] and kept:
            ropes.weight *= 1.5
        shares.append(ropes.share)
        yield from steps(3, 0.0)
    for ropes.weight in (0.1, 0.01, *[0.001] * 10):  # towards the least displacement, ropes touching
        if ropes.length_error(now) <= 10.0 * KEPT:
            ropes.thicken(now, 0.995 * ropes.room(now))
        yield from steps(20, 1e-3)
        if ropes.weight == 0.001 and ropes.length_error(now) <= KEPT:
            break
    share = ropes.share
    if ropes.length_error(now) <= KEPT:
        ropes.thicken(now, 0.995 * ropes.room(now))
    if ropes.share > share:
        yield ropes.iterate(index + 1, now)
    return _outcome(ropes, now, crossings)


def _outcome(ropes: Ropes, curve: Curve, crossings: tuple[Crossing, ...]) -> Separated:
    """How it ended, with the place where it is tight if there is too little room."""
    moved = float(np.linalg.norm(curve.vertices - ropes.given.vertices, axis=1).max())
    told = [Message("no point moved by more than {moved:.3g}", moved=moved)]
    told += [each.sentence for each in crossings[:3]]
    if len(crossings) > 3:
        told.append(Message("further crossings: {count}", count=len(crossings) - 3))
    facts: dict[str, Any] = {"share": ropes.share, "crossings": crossings, "moved": moved}
    if ropes.length_error(curve) > KEPT:
        change = np.abs(curve.edge_lengths / ropes.given.edge_lengths - 1.0)
        k = int(change.argmax())
        one, place = Message(COMPONENT, number=int(curve.mesh.edge_component[k]) + 1), at_edges(curve, (k,))
        kept = "lengths cannot be kept: that of {one} changes by up to {change:.2g} %, near {place}"
        reason = Message(kept, one=one, change=100.0 * change[k], place=written(np.array(place.position)))
        return Separated(Status.STALLED, (*stalled(reason).clauses, *told), place=place, **facts)
    if ropes.share == 1.0:
        return Separated(Status.CONVERGED, (Message("separated: all ropes keep clear"), *told), **facts)
    share, contact, x = max(ropes.share, 1e-12), None, curve.vertices
    while contact is None:  # what is in the way of thicker ropes
        share *= 1.02
        contact = rope_motion(curve.mesh, x, x, share * ropes.radius, ropes.obstacles).contact
    place = at_edges(curve, contact.edges)
    i, j = contact.edges[0], contact.edges[-1]
    one, other = (Message(COMPONENT, number=int(curve.mesh.edge_component[each]) + 1) for each in (i, j))
    where = Message("between {one} and {other}", one=one, other=other)
    if contact.obstacle:
        where = Message("between {one} and {other}", one=one, other=contact.obstacle)
    elif curve.mesh.next[i] == j or curve.mesh.next[j] == i:
        where = Message("at a corner of {one}", one=one)
    elif one == other:
        where = Message("between parts of {one}", one=one)
    tight = "there is room for {share:.3g} % of the radius only; it is tight {where}, near {place}"
    reason = Message(tight, share=100.0 * ropes.share, where=where, place=written(np.array(place.position)))
    return Separated(Status.STALLED, (*stalled(reason).clauses, *told), place=place, **facts)
