"""What a flow does to links: unlinked parts drift apart, composite ones pull tight, and open knots come undone."""

import logging
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from ...base import COMPONENT, Message, MobiusFlowError
from ...curve import STRAND_RATIO, Curve, Mesh, Obstacle, arc_distance_of_pairs, near_by_octave
from ...descent import Step
from ...energies.barrier import near_pairs
from ...energies.hierarchy import moebius_energy
from ...knots import Effort, knot_type
from ...knots.closures import closed_far_away
from ...knots.composite import Ball, is_searchable, knotted_ball
from ...solve.constraints import Barycenters, Parts
from ..move import Change, Move
from ..outcome import Outcome
from ..run import Run

UNTESTED = "whether the link is composite was not tested, as there are too many ways to divide it"
DIRECTIONS = np.array([[3, 1, 2], [-2, 3, 1], [1, -2, 3], [-3, -1, 2], [2, -3, -1]]) / np.sqrt(14)
EFFORT = Effort(vertices=5000, views=3, work=100_000)
_log = logging.getLogger(__name__)


@dataclass(eq=False)
class SplitLinks(Move):
    """Give every part that is far from the others a barycenter of its own among the constraints."""

    interval: int = 5  # accepted steps between two checks
    gap: float = 1.0  # least gap between the balls around two parts, in radii of the larger ball
    most: int = 50  # parts: each has rows of its own in the linear systems

    def stepped(self, step: Step) -> Change | None:
        run, constraints = self.run, self.run.problem.constraints
        if not run.problem.geometry.prescribes or run.iterate.index % self.interval:
            return None
        parts = separate_parts(run.iterate.curve, run.problem.obstacles, self.gap, self.most)
        if max(parts) <= max(constraints.barycenters.parts):
            return None
        held = Barycenters.of(run.point.curve, constraints.pins, parts)
        return Change(point=run.point.changing(constraints=replace(constraints, barycenters=held)))

    def converged(self, outcome: Outcome) -> Outcome | None:
        """Report the sum of the parts' own energies, unless pins hold them all."""
        held = self.run.problem.constraints.barycenters
        if not max(held.parts) or not held.loose:
            return None
        alone = sum(moebius_energy(part)[0] for part in split(self.run.iterate.curve, held.parts))
        told = (
            "unlinked parts, which would drift apart without limit, are held in place; their own energies add up to "
            "{energy:.6g}"
        )
        return outcome.adding(told, energy=alone)


def separate_parts(
    curve: Curve, obstacles: Sequence[Obstacle] = (), gap: float = SplitLinks.gap, most: int = SplitLinks.most
) -> Parts:
    """For each component the number of its part, from 0; parts lie in balls that are far from each other.

    Disjoint balls prove that parts are not linked.  Everything is one part if there would be too many.  All
    obstacles count as one body, merged with any part near it: between walls nothing drifts away.
    """
    components = len(curve.mesh.component_sizes)
    if components == 1:
        return (0,)
    points = [curve.vertices, *(obstacle.corners.reshape(-1, curve.dimension) for obstacle in obstacles)]
    member = np.concatenate([curve.mesh.component, np.full(sum(map(len, points[1:])), components)])
    count = components + bool(obstacles)
    part = np.arange(count)
    while count > 1:
        own = part[member]
        order = np.argsort(own, kind="stable")
        placed, own = np.concatenate(points)[order], own[order]
        starts = np.searchsorted(own, np.arange(count))
        centers = 0.5 * (np.minimum.reduceat(placed, starts) + np.maximum.reduceat(placed, starts))
        radii = np.maximum.reduceat(np.linalg.norm(placed - centers[own], axis=1), starts)
        i, j, distance = near_by_octave(centers, radii, 2.0 + gap)
        near = distance < radii[i] + radii[j] + gap * np.maximum(radii[i], radii[j])  # too near to be separate parts
        graph = sp.coo_array((near[near], (i[near], j[near])), shape=(count, count))
        fewer, merged = connected_components(graph, directed=False)
        if fewer == count:
            break
        part, count = merged[part], fewer
    _, part = np.unique(part[:components], return_inverse=True)  # without one of obstacles alone
    return tuple(part.tolist()) if count <= most else (0,) * components


def split(curve: Curve, parts: Parts) -> list[Curve]:
    """The parts as curves of their own."""
    own = [np.flatnonzero(np.asarray(parts) == k) for k in range(max(parts) + 1)]
    return [
        Curve.from_components([curve.components[c] for c in each], [curve.mesh.closed[c] for c in each]) for each in own
    ]


@dataclass(eq=False)
class Composite(Move):
    """Report composite curves: unless energy depends on size, only the mesh keeps a part from shrinking to a point."""

    def converged(self, outcome: Outcome) -> Outcome | None:
        ball = shrinking_ball(self.run)
        if ball is None:
            return None if all(map(is_searchable, _may_shrink(self.run))) else outcome.adding(UNTESTED)
        composite = (
            "strands pull tight without limit: the curve is composite, knotted both inside and outside the ball of "
            "radius {radius:.3g} around ({center}), and has no shape of least energy"
        )
        center = ", ".join(f"{x:.3g}" for x in ball.center)
        return replace(outcome.stalling(composite, radius=ball.radius, center=center), unbounded=True)


def shrinking_ball(run: Run) -> Ball | None:
    """A ball around a part of a composite curve that shrinks to a point; None if there is none, or none was found."""
    ball = next(filter(None, map(knotted_ball, _may_shrink(run))), None)
    # around a fixed obstacle nothing shrinks to a point
    return ball if ball is not None and all(map(ball.is_clear_of, run.problem.obstacles)) else None


def is_unresolved(curve: Curve) -> bool:
    """Whether strands, not merely edges of very different lengths, are so near that the barrier still acts."""
    i, j = near_pairs(curve)
    distance = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
    return bool(np.any(arc_distance_of_pairs(curve, i, j) > STRAND_RATIO * distance))


def _may_shrink(run: Run) -> list[Curve]:
    """The curve's parts that may be composite; none if energy depends on size, or with pins, where no part shrinks.

    They are closed and in space, as arcs can be unknotted, have the energy for it, and are no longer resolved, as when
    a part has shrunk as far as the mesh allows.
    """
    if run.problem.objective.sees_size or len(run.problem.constraints.pins):
        return []
    return [
        part
        for part in split(run.iterate.curve, run.problem.constraints.barycenters.parts)
        if part.dimension == 3 and part.mesh.all_closed and is_unresolved(part)
        # less than any composite has: two trefoils (74.4 each) less a circle make 144.8, two Hopf links (47.5 each) 91
        if moebius_energy(part)[0] >= (140.0 if len(part.mesh.component_sizes) == 1 else 90.0)
    ]


@dataclass(eq=False)
class OpenKnots(Move):
    """Warn where an open component is knotted and has a free end, and add what became of it."""

    lasts = True  # what the run began with counts

    def __post_init__(self) -> None:
        curve, pins = self.run.iterate.curve, set(self.run.iterate.pins)
        self._before, last_ones = open_knots(curve), np.cumsum(curve.mesh.component_sizes)
        for k, name in self._before.items():
            last = int(last_ones[k])
            if not pins >= {last - len(curve.components[k]), last - 1}:
                _log.warning(
                    "component %d is open and knotted (%s, if its ends are joined far away): its ends are free, so "
                    "that it straightens and loses the knot; pin both ends, or close it, to keep the knot",
                    k + 1,
                    name,
                )

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with a clause for each knot that is lost."""
        after = open_knots(self.run.iterate.curve) if self._before else {}
        for k, name in self._before.items():
            if after.get(k) != name:
                lost = "{component}, which is open, was {type} if its ends are joined far away, and is not any more"
                outcome = outcome.adding(lost, component=Message(COMPONENT, number=k + 1), type=name)
        return outcome


def open_knots(curve: Curve) -> dict[int, str]:
    """The types of open components, by their indices, with their ends joined far out: those of most directions.

    Each is taken by itself.  Trivial ones are left out, and those that are not identified.
    """
    found: dict[int, str] = {}
    for k, (points, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        if closed or curve.dimension != 3 or len(points) < 4:
            continue
        arc, names = Curve(points, Mesh((len(points),), (False,))), Counter[str]()
        for x, y, z in DIRECTIONS.tolist():
            with suppress(MobiusFlowError):  # an end points there: it is closed along itself
                kind = knot_type(closed_far_away(arc, (x, y, z)), EFFORT)
                names[str(kind) if kind.names else "unknot"] += 1
        name, times = next(iter(names.most_common(1)), ("unknot", 0))
        if 2 * times > len(DIRECTIONS) and name != "unknot":
            found[k] = name
    return found
