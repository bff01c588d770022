"""Pull knots and links tight: the flow spreads them out, and then the rope keeps its radius while it gets shorter.

Few vertices find the shape, more of them the length: the error of a polygon falls with the square of its edges.
"""

import math
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..base.arguments import check_options, checked, option
from ..base.deadline import TimeIsUp
from ..base.errors import CurveError, OptionError
from ..base.messages import Message
from ..base.threads import BLAS
from ..collision import thickness
from ..curve import Curve, subdivide
from ..descent.task import Task
from ..driver import Outcome, Relaxation, RelaxOptions, Result, Status, finish, relax
from ..driver.move import iterates
from ..driver.options import time_limit
from ..driver.prepare import rope_radius, start_problem
from ..driver.relax import bounded
from ..driver.run import Run
from ..energies.rope import Rope
from ..io.trajectory import Iterate
from ..knots import knot_type
from ..knots.planar import redrawn
from .pulled_rope import COARSE, GAP, PER_CONTROL, PulledRope

Trial = tuple[PulledRope, list[Iterate]]  # and the way it went
ELSEWHERE = "it begins at another drawing of the same type; no motion from the given curve is recorded"


@dataclass(frozen=True, kw_only=True)
class TightenOptions:
    """How a knot is pulled tight; open components stay polygons."""

    vertices: int | None = option(
        None,
        "Vertices",
        "vertices in the end, or up to twice as many",
        automatic="800, and 400 of open ropes",
        low=COARSE,
        high=20_000,
    )
    radius: float | None = option(
        None,
        "Radius",
        "radius of the rope, at most nine tenths of the curve's thickness",
        automatic="those",
        low=0,
        metavar="R",
    )
    starts: int = option(
        1,
        "Starts",
        "starts on few vertices, all but the first drawn anew; the shortest go on to the end",
        low=1,
        high=20_000,
        metavar="K",
    )
    seed: int = option(0, "Seed", "seed of the drawings", low=0, high=20_000, metavar="S")
    time_limit: float | None = time_limit()

    def __post_init__(self) -> None:
        check_options(self)


class Strut(NamedTuple):
    """Two edges that press on each other, and the force, relative to the tension of the rope."""

    edge: int
    other: int
    force: float


@dataclass(frozen=True)
class Tightened(Outcome):
    """How tightening ended.

    - ``ropelength``: length over thickness; 0 of straight ropes, which have none.
    - ``gap``: Σ force × clearance, relative to the length: by about that part the rope could still be shorter.
    - ``residual``: what forces lack to be in equilibrium, relative to the tension.
    - ``struts``: where strands press on each other.
    """

    ropelength: float = 0.0
    gap: float = math.inf
    residual: float = math.inf
    struts: tuple[Strut, ...] = field(default=(), repr=False)  # thousands


@checked
def tighten(
    curve: Curve | Task,
    *,
    vertices: int | None = None,
    radius: float | None = None,
    starts: int = 1,
    seed: int = 0,
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Pull a knot or link tight: as short as a rope of its ``radius`` can be, by default and at most nine tenths of the
    curve's thickness.

    In the end there are ``vertices`` or up to twice as many, by default 800, and 400 of open ropes.  What is tight is
    only refined.  Of several ``starts`` all but the first are drawn anew from other diagrams (`redrawn`), in the same
    place, with handedness and components as they are, but no motion there is recorded.  Those that are
    nearly the shortest on few vertices are compared on twice as many, and those that still are to the end; the best is
    the result, whose way begins at its start.  Open ropes, unknots and links that come apart have one.
    ``energy`` of iterates is length over radius, ``gradient_norm`` the residual.  The result's outcome is a
    `Tightened`, unless it was cut short.

    Open ropes are pulled by their ends, which go straight ahead as rope comes out of the knot.  The start must have
    long ends: nothing keeps strands from slipping over them.

    Raises CurveError if the curve is not in space, touches itself or is too thin for a rope; OptionError if
    there are pins or obstacles, or numbers are out of range.
    """
    task = Task.of(curve)
    return finish(
        tightening(task, TightenOptions(vertices=vertices, radius=radius, starts=starts, seed=seed)), task, callback
    )


@BLAS.bounded()
def tightening(task: Task, options: TightenOptions) -> Relaxation:
    """Yield the curve and all steps on its way; return how it ended, a `Tightened`.  Raises as `tighten` does."""
    began = time.perf_counter()
    if task.pins or task.obstacles:
        raise OptionError("a knot is pulled tight in free space; leave pins and obstacles out")
    if task.curve.dimension != 3:
        raise CurveError(f"the curve has dimension {task.curve.dimension}; only curves in space are pulled tight")
    # open ropes stay as long as they are, so that edges become shorter only where they are cut, once at least
    few, vertices = (COARSE, 800) if task.curve.mesh.all_closed else (2 * COARSE, 400)
    vertices = options.vertices or vertices
    coarse = vertices >> max(0, int(math.log2(vertices / few)))
    if not task.curve.mesh.all_closed:
        vertices = max(vertices, coarse + 1)
    start = task.refined(max(len(task.curve), coarse))
    cuts = np.ceil(32.0 / np.asarray(start.curve.mesh.component_sizes)).astype(np.intp)  # of edges of small components
    start = Task.of(subdivide(start.curve, cuts[start.curve.mesh.edge_component]))
    found = rope_radius(start, RelaxOptions(radius="keep"))
    if found is None:
        raise CurveError("the curve is no rope: a corner is too sharp, or strands are too near; smooth or relax it")
    thick, wanted = float(found.min()), options.radius or math.inf
    unit = min(thick, wanted)
    away = float(np.abs(start.curve.vertices.mean(axis=0)).max())
    size = float(np.ptp(start.curve.vertices, axis=0).max())
    if size > 1e4 * unit:
        remedy = "give a larger radius" if unit == wanted else "smooth or relax it"
        raise CurveError(f"the curve is {size:.3g} wide, too much for ropes of radius {unit:.3g}; {remedy}")
    if away > 1e3 * unit:  # of such coordinates too few digits are left for strands that touch
        raise CurveError(
            f"the curve is {away:.3g} from the origin, too far for ropes of radius {unit:.3g}; move it there"
        )
    if unknot := knot_type(start.curve).names == ("0_1",):  # the flow that undoes it needs its own mesh
        start, thick = task.refined(), math.inf
    if unknot or not start.curve.mesh.all_closed:  # which are not scaled until they fit
        thick = min(thick, 0.9 * thickness(start.curve))
    unit = min(thick, wanted)
    if not start.curve.mesh.all_closed:  # of edges longer than six radii no knot can be made
        unit = max(unit, min(thick, start.curve.length / (6.0 * coarse)))
    return bounded(_tightened(start, thick, unit, coarse, vertices, unknot, options), options.time_limit, began)


def _spread(start: Task, thick: float, unit: float, unknot: bool, number: int) -> tuple[PulledRope, Iterable[Iterate]]:
    """The rope of a start, by its number, and its way along a flow that spreads it out; none if it is tight already.

    The flow is that of a rope as ``thick`` as the curve, whose strands feel each other.
    """
    most = 2000 if unknot else 300  # knots take up to a hundred, parts that are not linked would part for ever
    if number and number % 3 == 0:  # spread a little only: those that are spread out are shorter, but of fewer shapes
        most = 20
    options = RelaxOptions(
        barrier="off" if number else "on",  # drawings' strands are apart, and their rope keeps them so
        max_iterations=most,
        mesh="fixed",
        radius=thick,
        tolerance=1e-2,
        untangle="never",
        vertices=len(start.curve),
    )
    if unknot:  # forces may balance wherever it is packed, but the flow and its moves bring it to the circle
        flow = relax(start, options)
        return (rope := PulledRope(next(flow), unit)), rope.spread(flow)
    problem = start_problem(replace(start, pins=tuple(start.curve.mesh.ends.ravel().tolist())), options)
    assert problem.objective.rope is not None, "it has a radius"
    # strands that keep away from each other from afar find shorter shapes, for which there is less to do, too
    far = Rope(problem.objective.rope.radius, weight=0.5, reach=5.0, share=np.inf)
    problem = replace(problem, objective=problem.objective.having(Rope, far))
    flow = iterates(Run(problem, start.curve, options), ())
    rope = PulledRope(next(flow), unit)
    # over ends strands could slip
    return rope, () if not start.curve.mesh.all_closed or rope.is_tight else rope.spread(flow)


def _tightened(
    start: Task, thick: float, unit: float, coarse: int, vertices: int, unknot: bool, wanted: TightenOptions
) -> Relaxation:
    alone = wanted.starts == 1 or unknot or not start.curve.mesh.all_closed
    trials, fine = list[Trial](), vertices // PER_CONTROL

    def starts() -> Iterator[Task]:
        yield start
        for other in () if alone else redrawn(start.curve, wanted.starts - 1, wanted.seed):
            task = Task.of(other).refined(max(len(other), coarse))
            found, x = rope_radius(task, RelaxOptions(radius="keep")), task.curve.vertices
            if found is not None:  # they are ropes of the same radius in the same place
                x = start.curve.vertices.mean(axis=0) + (1.0 + 1e-6) * thick / found.min() * (x - x.mean(axis=0))
                yield Task.of(task.curve.with_vertices(x))

    def near(several: list[Trial], width: float) -> list[Trial]:
        """The first, and of each other shape the shortest, if little longer than any of about as many vertices."""
        found = list[Trial]()
        for trial in several[:1] + sorted(several[1:], key=lambda each: each[0].promise):
            rope, n = trial[0], len(trial[0].curve)
            least = min(other.promise for other, _ in several if abs(len(other.curve) - n) < 0.1 * n)
            differs = [np.abs(other.shape / rope.shape - 1.0).max() > 5e-3 for other, _ in found]
            if not found or (rope.promise < width * least and all(differs)):
                found.append(trial)
        return found

    try:
        for number, each in enumerate(starts()):
            rope, spread = _spread(each, thick, unit, unknot, number)
            if alone and min(fine, len(rope.curve)) >= 2 * COARSE and each.curve.mesh.all_closed and spread == ():
                steps = chain(rope.thinned(fine), rope.shrunk())  # it is tight: it is refined only
            else:
                steps = chain(spread, rope.thinned(coarse), rope.shrunk(), rope.pulled())
            if alone:
                yield rope.last
                yield from chain(steps, rope.finished(vertices))
            else:
                trials.append((rope, way := [rope.last]))
                way += steps
        several = near(trials, 1.01)  # with the given curve's, so that more starts never end longer than one
        if 4 * coarse < vertices:  # finer meshes, which are not the last ones, tell more
            for rope, way in several:
                way += chain(rope.refined(vertices), rope.pulled())
            several = near(several, 1.0015)  # by so much promises of one shape differ
        for rope, way in several[:4]:
            way += rope.finished(vertices)
        if several:  # of the same shapes that to which a motion leads
            least = min(rope.last.energy for rope, _ in several)
            rope, way = next(each for each in several if each[0].last.energy <= (1.0 + 1e-5) * least)
    except (TimeIsUp, KeyboardInterrupt, MemoryError) as stop:
        if trials:  # the shortest so far
            rope, way = min(trials, key=lambda trial: trial[0].last.energy)
            yield from way
            if rope is not trials[0][0]:
                stop.add_note(Message(ELSEWHERE))
        raise
    if trials:
        yield from way
    outcome = _ended(rope, elsewhere=bool(trials) and rope is not trials[0][0])
    if wanted.radius and unit != wanted.radius:
        return outcome.adding("its radius is {unit:.4g}, which fits the curve and its vertices", unit=unit)
    return outcome


def _ended(rope: PulledRope, elsewhere: bool) -> Outcome:
    """How tightening ended; ``elsewhere`` than at the given curve its way may have begun."""
    point = rope.point
    assert point is not None, "it has been pulled"
    contacts, strands = point.contacts, slice(point.contacts.strands)
    struts = zip(*(x[strands].tolist() for x in (contacts.i, contacts.j, point.forces)), strict=True)
    ropelength, gap, residual = rope.curve.length / thickness(rope.curve), point.gap, point.residual
    template = "ropelength {ropelength:.7g}, gap {gap:.1g}, residual {residual:.1g}"
    told = Message(template, ropelength=ropelength, gap=gap, residual=residual)
    if not any(rope.curve.mesh.closed) and point.excess < 1e-3:
        straight = Message("the rope is straight, as no knot was in it")
        return Tightened(Status.CONVERGED, (straight,), gap=gap, residual=residual)
    if gap <= GAP and residual <= 10.0 * GAP:
        status, said = Status.CONVERGED, Message("converged: {told}", told=told)
    else:
        status, said = Status.STALLED, Message("stalled: forces are not in equilibrium: {told}", told=told)
    pressing = tuple(Strut(*each) for each in struts if each[2] > 1e-4)
    outcome: Outcome = Tightened(status, (said,), ropelength=ropelength, gap=gap, residual=residual, struts=pressing)
    if elsewhere:
        outcome = outcome.adding(ELSEWHERE)
    if not rope.curve.mesh.all_closed and point.excess >= 1e-3:
        return outcome.adding("{excess:.5g} radii of rope are in the knot", excess=point.excess)
    if (point.curve.component_lengths < 2.01 * math.pi).all():
        return outcome.adding("circles of the rope's radius are left, as of unknots")
    return outcome
