"""Target lengths grow or shrink to a multiple of the lengths at the start, as fast as anything in the way allows."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ...collision import Contact, walk
from ...curve import SPLIT, affordable_pieces, at_edges, graded_spacing, spans
from ...descent import Leg, NoStep, Point, Step, Units, attempt, leg, on_target
from ...energies.components import energy_scale
from ..move import Change, Event, Move
from ..outcome import Outcome
from .remesh import FinerMesh, split_edges


@dataclass(eq=False)
class Grow(Move):
    """Change the lengths, by motions proved like all others, each after the steps since the last have settled."""

    # fastest, slowest: logarithmic change of the lengths in one motion; less is not worth an iteration
    fastest: float = 0.2
    slowest: float = 0.01
    # of the objective, by its scale, in one motion: contacts make more, and take long to relax from
    rise: float = 0.25
    settled: float = 0.01  # decrease of the objective in a step, by its scale, after which the next may come
    later: float = 0.1  # factor on ``settled`` after no motion was found
    edges_per_gap: float = 2.0  # packed curves bend as tightly as strands are near, and twice as many of ropes: evenly
    most: int = FinerMesh.most  # vertices, unless there are more already
    _energy: float = field(default=math.inf, init=False)  # after the last event
    _in_the_way: Contact | None = field(default=None, init=False)  # of the last motion that failed, if it was contact

    def __post_init__(self) -> None:
        self._longest, self._enough = self.fastest, self.settled
        self._is_done = self.run.options.grow == 1.0
        rope = self.run.problem.radius is not None
        self._resolution = replace(self.run.resolution, edges_per_gap=(1 + rope) * self.edges_per_gap)

    def __call__(self, event: Event) -> Event | Change:
        """Act at the start, after steps that gained little, and where the run would end with other lengths."""
        if self._is_done or (isinstance(event, Outcome) and not event.converged):
            return event
        point, problem = self.run.point, self.run.problem
        left = float(np.log(self.run.options.grow / self.run.iterate.grown))
        reached = abs(left) <= 1e-9  # rounding
        if not (reached or problem.obstacles or len(problem.constraints.pins)):
            # nothing is in the way but a rope itself, of which shorter legs tell more: scale about the barycenter
            start, legs = self.run.iterate.curve, list[Leg]()

            def scaled(place: float, stride: float) -> Leg | None:
                factor = float(np.exp(np.copysign(min(place + stride, abs(left)), left)))
                curve = start.with_vertices(start.barycenter + factor * (start.vertices - start.barycenter))
                grown = replace(problem, constraints=problem.constraints.scaled(factor, problem.mesh))
                found = leg(legs[-1].end if legs else point, grown.at_curve(curve))
                self._in_the_way = found.proof.contact
                return found if found.open else None

            for _, found in walk(scaled, abs(left), abs(left), self.slowest):
                legs.append(found)
            if legs:
                return Change((Step(tuple(legs), 0.0, None),), self._resolved(legs[-1].end))
        # motions wait until it is almost at rest; arcs may have practically no energy
        before, self._energy = self._energy, point.energy
        scale = energy_scale(problem.mesh, point.energy)
        if not isinstance(event, NoStep | Outcome):
            gained = before - self._energy if isinstance(event, Step) else 0.0
            if not on_target(point) or gained > self._enough * scale:
                return event
        # another mesh comes before the next motion: right after one strands are too near
        resolved = self._resolved(point)
        if resolved is not None:
            return Change(point=resolved)
        self._is_done = reached
        if reached:
            return event
        # the shortest motion in the metric that makes as much of the remaining change as possible; the least change
        # worth an iteration is half of the slack of an arc that is nearly straight
        spanned = spans(point.curve, problem.constraints.pins.vertices)
        slack = (0.5 * float(np.log(span.length / span.distance)) for span in spanned if not span.taut)

        def changed(_: float, stride: float) -> Leg | None:
            constraints = problem.constraints.scaled(np.exp(np.copysign(stride, left)), problem.mesh)
            base, space = point.changing(constraints=constraints), point.tangent_space
            aim, most = base.vertices - space.pseudo_inverse(base.residual), point.energy + self.rise * scale
            found = attempt(base, aim, np.zeros_like(base.residual), lambda end: end.energy <= most, space)
            if isinstance(found, Leg):
                return found
            self._in_the_way = found.in_the_way or self._in_the_way
            return None

        longest, shortest = min(abs(left), self._longest), min(self.slowest, abs(left), *slack)
        for change, found in walk(changed, abs(left), longest, shortest):
            self._longest, self._enough = min(2.0 * change, self.fastest), self.settled
            self._energy = found.end.energy
            return Change((Step((found,), 0.0, None),))
        self._enough *= self.later
        if not isinstance(event, Outcome):
            return event
        if self._in_the_way is None:
            return event.stalling("every motion that changes the lengths as requested costs too much energy")
        told = "every motion that changes the lengths as requested brings {contact} too near, or costs too much energy"
        place = at_edges(point.curve.with_vertices(point.placed), self._in_the_way.edges)
        return replace(event.stalling(told, contact=self._in_the_way.message), place=place)

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with a clause on how far lengths have come, if they were to change."""
        wanted, grew = self.run.options.grow, "grew to {grown:.6g} of {wanted:.6g} times its length"
        return outcome if wanted == 1.0 else outcome.adding(grew, grown=self.run.iterate.grown, wanted=wanted)

    def _resolved(self, point: Point) -> Point | None:
        """The point on a mesh and in units that suit its length; None if the present ones do, or none are better."""
        problem, curve = point.problem, point.curve.with_vertices(point.placed)
        pieces = np.ones(curve.mesh.edges, dtype=np.intp)  # into which each edge is to be split
        if self.run.options.mesh != "fixed":
            spacing = graded_spacing(curve, self._resolution)
            if (curve.edge_lengths > SPLIT * spacing).any():
                pieces = affordable_pieces(curve, spacing, self.most)
        if pieces.max() == 1 and Units.of(curve).scale == problem.units.scale:
            return None
        return split_edges(problem, curve, pieces)
