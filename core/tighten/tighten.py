"""Pull knots and links tight: the flow spreads them out, and then the rope keeps its radius while it gets shorter.

All motions are proved those of a rope.  Few vertices find the shape, more of them the length: the error of a polygon
falls with the square of its edges.  Where vertices double, every edge is halved, which leaves the curve as it is, and
all vertices move on by half an edge, which cuts corners.
"""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..base.arguments import check_number, checked
from ..base.deadline import TimeLimit
from ..base.errors import CurveError, OptionError
from ..base.messages import Message
from ..base.threads import BLAS
from ..base.types import FloatArray
from ..collision import is_rope, thickness
from ..collision.motion import walk
from ..curve import Curve
from ..curve.refine import onto_chords, subdivide
from ..descent.task import Task, check_refined
from ..driver import Outcome, Relaxation, RelaxOptions, Result, Status, finish, relax
from ..driver.moves.hops import Field, random_flow
from ..driver.moves.hops import radius as radius_of_gyration
from ..driver.prepare import rope_radius
from ..driver.relax import within
from ..io.trajectory import Iterate
from .contacts import Contacts
from .interior_point import FALL, InteriorPoint

COARSE = 100  # vertices that find the shape, up to twice as many
MOST = 20_000  # of vertices, starts and seeds
GAP = 1e-6  # of forces times clearances, relative to the length, at rest
ROOM = 1e-6  # of the radius, which motions are proved with: between their ends strands come a little nearer
WEIGHT = 0.03  # of the barrier, in squares of edges
FINAL = 3  # starts that go on to the end
SHRINK = 0.95  # of the size at least is left at once, where nothing touches


@dataclass(frozen=True, kw_only=True)
class TightenOptions:
    """How a knot is pulled tight: ``vertices`` in the end, or up to twice as many, and ``starts``, drawn by a seed."""

    vertices: int = 400
    starts: int = 1
    seed: int = 0
    time_limit: float | None = None

    def __post_init__(self) -> None:
        for name, low in (("vertices", COARSE), ("starts", 1), ("seed", 0)):
            check_number(name, getattr(self, name), low - 1, MOST)
        if self.time_limit is not None:
            check_number("time_limit", self.time_limit, 0.0, math.inf)


class Strut(NamedTuple):
    """Two edges that press on each other, and the force, relative to the tension of the rope."""

    edge: int
    other: int
    force: float


@dataclass(frozen=True)
class Tightened(Outcome):
    """How tightening ended.

    - ``ropelength``: length over thickness.
    - ``gap``: Σ force × clearance, relative to the length: by about that part the rope could still be shorter.
    - ``residual``: what forces lack to be in equilibrium, relative to the tension.
    - ``struts``: where strands press on each other.
    """

    ropelength: float = 0.0
    gap: float = math.inf
    residual: float = math.inf
    struts: tuple[Strut, ...] = ()


@checked
def tighten(
    curve: Curve | Task,
    *,
    vertices: int = 400,
    starts: int = 1,
    seed: int = 0,
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Pull a knot or link tight: as short as a rope of its radius can be, nine tenths of the curve's thickness.

    In the end there are ``vertices`` or up to twice as many.  Of several ``starts`` all but the first are stirred at
    random; the three that are shortest on few vertices go on, and the best of them is kept.  ``energy`` of iterates is
    length over radius, ``gradient_norm`` the residual.  The result's outcome is a `Tightened`, unless it was cut short.

    Open ropes are pulled by their ends, which go straight ahead as rope comes out of the knot.  The start must have
    long ends: nothing keeps strands from slipping over them.

    Raises CurveError if the curve is not in space, touches itself or is too thin for a rope; OptionError if
    there are pins or obstacles, or numbers are out of range.
    """
    task = Task.of(curve)
    return finish(tightening(task, TightenOptions(vertices=vertices, starts=starts, seed=seed)), task, callback)


@BLAS.bounded()
def tightening(task: Task, options: TightenOptions) -> Relaxation:
    """Yield the curve and all steps on its way; return how it ended, a `Tightened`.  Raises as `tighten` does."""
    began = time.perf_counter()
    if task.pins or task.obstacles:
        raise OptionError("a knot is pulled tight in free space; leave pins and obstacles out")
    if task.curve.dimension != 3:
        raise CurveError(f"the curve has dimension {task.curve.dimension}; only curves in space are pulled tight")
    # open ropes stay as long as they are, so that edges do not become shorter
    few = COARSE if task.curve.mesh.all_closed else 2 * COARSE
    coarse = options.vertices >> max(0, int(math.log2(options.vertices / few)))
    start = task.refined(max(len(task.curve), coarse))
    thick = rope_radius(start, RelaxOptions(radius="keep"))
    if thick is None:
        raise CurveError("the curve is no rope: a corner is too sharp, or strands are too near; smooth or relax it")
    unit, away = float(thick.min()), float(np.abs(start.curve.vertices.mean(axis=0)).max())
    if away > 1e3 * unit:  # of such coordinates too few digits are left for strands that touch
        raise CurveError(
            f"the curve is {away:.3g} from the origin, too far for ropes of radius {unit:.3g}; move it there"
        )
    if not start.curve.mesh.all_closed:  # which are not scaled until they fit
        unit = min(unit, 0.9 * thickness(start.curve))
    work = BLAS.bounding(_tightened(start, unit, coarse, options))
    if options.time_limit is None:
        return work
    return within(TimeLimit(options.time_limit, used=time.perf_counter() - began), work)


def _tightened(start: Task, unit: float, coarse: int, wanted: TightenOptions) -> Relaxation:
    rng, size = np.random.default_rng(wanted.seed), len(start.curve)
    loosely = RelaxOptions(mesh="fixed", untangle="never", tolerance=1e-2, max_iterations=500)
    ends = tuple(start.curve.mesh.ends.ravel().tolist())
    flow = relax(replace(start, pins=ends), replace(loosely, radius=unit, vertices=size))
    rope = _Rope(next(flow), unit)
    yield rope.last
    if not rope.is_tight and start.curve.mesh.all_closed:  # strands could slip over ends
        for iterate in flow:
            yield from rope.follow(iterate.path, iterate.gradient_norm, iterate.step_size)
    yield from rope.thinned(coarse)
    if wanted.starts == 1:
        yield from rope.pulled(wanted.vertices)
        yield from rope.refined(wanted.vertices)
    else:
        trials = list[tuple[_Rope, list[Iterate]]]()
        for k in range(wanted.starts):
            trial = _Rope(rope.last, unit)
            trials.append((trial, [*(trial.stirred(rng) if k else ()), *trial.pulled(wanted.vertices)]))
        trials = sorted(trials, key=lambda each: each[0].promise)[:FINAL]
        for trial, way in trials:
            way += trial.refined(wanted.vertices)
        rope, way = min(trials, key=lambda each: each[0].promise)
        yield from way
    point = rope.point
    assert point is not None, "it has been pulled"
    contacts, strands = point.contacts, slice(point.contacts.strands)
    struts = zip(*(x[strands].tolist() for x in (contacts.i, contacts.j, point.forces)), strict=True)
    ropelength, gap, residual = rope.curve.length / thickness(rope.curve), point.gap, point.residual
    template = "ropelength {ropelength:.7g}, gap {gap:.1g}, residual {residual:.1g}"
    told = Message(template, ropelength=ropelength, gap=gap, residual=residual)
    if gap <= GAP and residual <= 10.0 * GAP:
        status, said = Status.CONVERGED, Message("converged: {told}", told=told)
    else:
        status, said = Status.STALLED, Message("stalled: forces are not in equilibrium: {told}", told=told)
    pressing = tuple(Strut(*each) for each in struts if each[2] > 1e-4)
    outcome = Tightened(status, (said,), ropelength=ropelength, gap=gap, residual=residual, struts=pressing)
    if not rope.curve.mesh.all_closed:
        if point.excess < 1e-3:
            return outcome.adding("the rope is straight, as no knot was in it")
        return outcome.adding("{excess:.5g} radii of rope are in the knot", excess=point.excess)
    if (point.curve.component_lengths < 2.01 * math.pi).all():
        return outcome.adding("circles of the rope's radius are left, as of unknots")
    return outcome


class _Rope:
    """The rope on its way: the last iterate, and the interior point on its mesh, in radii around a centre."""

    def __init__(self, last: Iterate, unit: float) -> None:
        radius = (unit * (1.0 - ROOM),) * len(last.curve.mesh.component_sizes)
        self.last = replace(last, pins=(), radius=radius, energy=last.curve.length / unit)
        self.unit, self.center = unit, last.curve.vertices.mean(axis=0)
        self.point: InteriorPoint | None = None

    @property
    def curve(self) -> Curve:
        return self.last.curve

    @property
    def is_tight(self) -> bool:
        """Whether half of the edges touch others, about as near as any do."""
        touching = Contacts.near(self.curve.with_vertices(self.curve.vertices / thickness(self.curve)), 0.1)
        strands = slice(touching.strands)
        return len(np.unique([touching.i[strands], touching.j[strands]])) > 0.5 * len(self.curve)

    @property
    def promise(self) -> float:
        """About how short the rope becomes, compared to others of as many vertices."""
        return self.point.merit if self.point else np.inf

    def proves(self, vertices: FloatArray) -> bool:
        return is_rope(self.curve.mesh, self.curve.vertices, vertices, np.array(self.last.radius))

    def follow(
        self, path: Sequence[FloatArray], residual: float | None = None, share: float = 0.0
    ) -> Iterator[Iterate]:
        """The iterate at the end of a path, with proved legs."""
        curve = self.curve.with_vertices(path[-1])
        self.last = replace(
            self.last,
            index=self.last.index + 1,
            curve=curve,
            energy=curve.length / self.unit,
            path=tuple(path),
            gradient_norm=self.last.gradient_norm if residual is None else residual,
            step_size=share,
            edge_length_error=0.0,
        )
        yield self.last

    def remeshed(self, curve: Curve) -> Iterator[Iterate]:
        """The same curve with other vertices on its edges."""
        self.last = replace(self.last, index=self.last.index + 1, curve=curve, path=(), step_size=0.0)
        yield self.last

    def thinned(self, count: int) -> Iterator[Iterate]:
        """As few vertices, as far as the way of the others onto the chords of their neighbours is proved."""
        while len(self.curve) > count:
            # evenly, and no neighbours
            mesh, every = self.curve.mesh, max(2.0, len(self.curve) / (len(self.curve) - count))
            firsts = mesh.offsets[:-1] + ~np.asarray(mesh.closed)  # ends stay
            gone = [
                np.arange(first, part.stop - 1, every).astype(np.intp)
                for first, part in zip(firsts, mesh.slices, strict=True)
            ]
            moved = self.curve.with_vertices(onto_chords(self.curve, np.concatenate(gone)))
            rest = [
                np.delete(points, k - part.start, axis=0)
                for points, k, part in zip(moved.components, gone, mesh.slices, strict=True)
            ]
            if min(map(len, rest)) < 16 or not self.proves(moved.vertices):
                return
            yield from self.follow([moved.vertices])
            yield from self.remeshed(Curve.from_components(rest, self.curve.mesh.closed))

    def stirred(self, rng: np.random.Generator) -> Iterator[Iterate]:
        """The rope after random motions."""
        for _ in range(15):
            velocity = random_flow(self.curve.vertices, rng, 4, 2.0)

            def moved(_: float, stride: float, velocity: Field = velocity) -> FloatArray | None:
                x = self.curve.vertices
                there = np.asarray(x + stride * radius_of_gyration(x) * velocity(x))
                return there if self.proves(there) else None

            for _, vertices in walk(moved, 0.5, 0.02, 0.005):
                yield from self.follow([vertices])

    def shrunk(self) -> Iterator[Iterate]:
        """The curve as small as its thickness allows, and a little larger than its rope needs."""
        if not self.curve.mesh.all_closed:
            return
        start, wanted = self.curve.vertices, 1.001 * self.unit / thickness(self.curve)
        steps = max(1, math.ceil(math.log(wanted) / math.log(SHRINK)))
        for k in range(1, steps + 1):
            yield from self.follow([self.center + wanted ** (k / steps) * (start - self.center)])

    def doubled(self) -> Iterator[Iterate]:
        """Twice as many vertices on a smoother curve, larger if the rope needs room; nothing if that is blocked."""
        before, finer = self.last, subdivide(self.curve, np.full(self.curve.mesh.edges, 2))
        check_refined(self.curve, finer, ())
        onward = finer.mesh.at_tails(0.5 * finer.edge_vectors)
        onward[finer.mesh.ends] = 0.0
        moved = finer.with_vertices(finer.vertices + onward)
        assert self.point is not None, "it has been pulled"
        larger = max(1.0, (1.0 + 0.5 * self.point.gap) * self.unit / thickness(moved))
        halved = [*self.remeshed(finer)]
        for scale in larger + 0.002 * np.arange(10):
            there = self.center + scale * (moved.vertices - self.center)
            if self.proves(there):
                yield from halved
                yield from self.follow([there])
                return
        self.last = before

    def refined(self, vertices: int) -> Iterator[Iterate]:
        """The rope pulled tight on more and more vertices."""
        while len(self.curve) < vertices:
            before = len(self.curve)
            yield from self.doubled()
            if len(self.curve) == before:
                return
            yield from self.pulled(vertices)

    def pulled(self, vertices: int) -> Iterator[Iterate]:
        """The steps of an interior point, on half as many vertices as the last one, to the end on so many."""
        if self.point is None:
            yield from self.shrunk()
        curve, last = self.curve.with_vertices((self.curve.vertices - self.center) / self.unit), self.point
        # as the square of edges, so that the barrier is about the same on all meshes, and then less
        mu, margin = WEIGHT * (curve.length / len(curve)) ** 2, 0.3
        if last is not None:
            mu, margin = 0.25 * FALL * last.mu, FALL**0.5 * last.margin

        def placed(vertices: FloatArray) -> FloatArray:
            return np.asarray(self.center + self.unit * vertices)

        self.point = point = InteriorPoint(curve, mu, lambda vertices: self.proves(placed(vertices)), margin)
        for share in point.run(GAP if len(curve) >= vertices else None):
            if share > 0.0:
                path = [placed(point.curve.vertices)]
                longer = curve.component_lengths - point.curve.component_lengths
                if not curve.mesh.all_closed and longer.min() > 0.0:
                    # what rope has come out of the knot leads ends on, straight ahead
                    ahead = point.curve.vertices.copy()
                    for first, last in curve.mesh.ends:
                        for end, inner in ((first, first + 1), (last, last - 1)):
                            edge = ahead[end] - ahead[inner]
                            ahead[end] += 0.5 * longer[curve.mesh.component[end]] * edge / np.linalg.norm(edge)
                    if is_rope(curve.mesh, path[0], placed(ahead), np.array(self.last.radius)):
                        path.append(placed(ahead))
                        point.curve = point.curve.with_vertices(ahead)
                yield from self.follow(path, point.residual, share)
