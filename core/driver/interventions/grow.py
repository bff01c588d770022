"""Target lengths grow or shrink to a multiple of the lengths at the start, as fast as anything in the way allows."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ...arguments import checked_fields, number
from ...constraints import weighted_barycenter
from ...curve import Curve
from ...curve.pins import spans
from ...curve.refine import affordable_pieces
from ...curve.remesh import SPLIT, graded_spacing
from ...descent import Leg, NoStep, Point, Step
from ...descent.searches.armijo import on_target
from ...descent.step import attempt
from ...energies.components import energy_scale
from ...task import Units
from ...types import IntArray
from ..outcome import Outcome
from ..run import Change, Event, Intervention, Run
from .remesh import FinerMesh, split_edges

REACHED = 1e-9  # logarithm of the factor that may be missing: rounding

CROWDED = "every motion that changes the lengths as requested causes contact or costs too much energy"


@checked_fields
@dataclass(eq=False)
class Grow(Intervention):
    """Change the lengths, by motions proved like all others, each after the steps since the last have settled."""

    # fastest, slowest: logarithmic change of the lengths in one motion; less is not worth an iteration
    fastest: float = number(0.2)
    slowest: float = number(0.01)
    # of the objective, by its scale, in one motion: contacts make more, and take long to relax from
    rise: float = number(0.25)
    settled: float = number(0.01)  # decrease of the objective in a step, by its scale, after which the next may come
    later: float = number(0.1, most=1)  # factor on ``settled`` after no motion was found
    edges_per_gap: float = number(2.0)  # packed curves bend as tightly as strands are near
    most: int = number(FinerMesh.most)  # vertices, unless there are more already
    _energy: float = field(default=math.inf, init=False)  # after the last event

    def __post_init__(self) -> None:
        self._longest, self._enough = self.fastest, self.settled
        self._is_done = self.run.options.grow == 1.0
        self._resolution = replace(self.run.resolution, edges_per_gap=self.edges_per_gap)

    def __call__(self, event: Event) -> Event | Change:
        """Act at the start, after steps that gained little, and where the run would end with other lengths."""
        if self._is_done or (isinstance(event, Outcome) and not event.converged):
            return event
        left = float(np.log(self.run.options.grow / self.run.iterate.grown))
        if abs(left) > REACHED and not (self.run.problem.obstacles or len(self.run.problem.constraints.pins)):
            return self._scaled(left)
        if not self._is_due(event):
            return event
        resolved = self._resolved(self.run.point)  # before the next motion: right after one strands are too near
        if resolved is not None:
            return Change(point=resolved)
        self._is_done = abs(left) <= REACHED
        return event if self._is_done else self._grown(left, event)

    def _is_due(self, event: Event) -> bool:
        """Whether there is nothing else to do, or the curve has its lengths and has almost come to rest."""
        before, self._energy = self._energy, self.run.point.energy
        if isinstance(event, NoStep | Outcome):
            return True
        gained = before - self._energy if isinstance(event, Step) else 0.0
        return on_target(self.run.point) and gained <= self._enough * self._energy_scale

    def _grown(self, left: float, event: Event) -> Event | Change:
        step = self._step(left)
        if step is not None:
            self._energy = step.point.energy
            return Change((step,))
        return event.stalling(CROWDED) if isinstance(event, Outcome) else event

    def _scaled(self, left: float) -> Change:
        """Scale the whole curve about its barycenter, as nothing is in the way."""
        start, problem, factor = self.run.iterate.curve, self.run.problem, float(np.exp(left))
        center = weighted_barycenter(start) / start.length
        end = start.with_vertices(center + factor * (start.vertices - center))
        proof = problem.free_motion(start.vertices, end.vertices)
        constraints = problem.constraints.scaled(factor, problem.mesh)
        step = Step((Leg(replace(problem, constraints=constraints).at_curve(end), proof),), 0.0, None)
        return Change((step,), self._resolved(step.point))

    def _step(self, left: float) -> Step | None:
        """The shortest motion in the metric that makes as much of the remaining change as possible; None if none."""
        point, problem = self.run.point, self.run.problem
        space, change = point.tangent_space, float(np.clip(left, -self._longest, self._longest))
        # the least change worth an iteration: for an arc that is nearly straight, half of its slack
        spanned = spans(self.run.point.curve, self.run.problem.constraints.pins.vertices)
        slack = (0.5 * float(np.log(span.length / span.distance)) for span in spanned if not span.taut)
        least = min(self.slowest, abs(left), *slack)
        while abs(change) >= least:
            constraints = problem.constraints.scaled(np.exp(change), problem.mesh)
            base = point.changing(constraints=constraints)
            aim = base.vertices - space.pseudo_inverse(base.residual)
            found = attempt(base, aim, np.zeros_like(base.residual), self._is_cheap, space)
            if isinstance(found, Leg):
                self._longest, self._enough = min(2.0 * abs(change), self.fastest), self.settled
                return Step((found,), 0.0, None)
            change *= 0.5
        self._enough *= self.later
        return None

    def _is_cheap(self, end: Point) -> bool:
        return end.energy - self.run.point.energy <= self.rise * self._energy_scale

    @property
    def _energy_scale(self) -> float:
        """The scale for rises and decreases of the objective: arcs may have practically no energy."""
        return energy_scale(self.run.problem.mesh, self.run.point.energy)

    def _resolved(self, point: Point) -> Point | None:
        """The point on a mesh and in units that suit its length; None if the present ones do, or none are better."""
        problem, curve = point.problem, point.curve.with_vertices(point.placed)
        pieces = self._pieces(curve)
        if pieces.max() == 1 and Units.of(curve).scale == problem.units.scale:
            return None
        return split_edges(problem, curve, pieces)

    def _pieces(self, curve: Curve) -> IntArray:
        """The number of pieces into which each edge is to be split."""
        whole = np.ones(curve.mesh.edges, dtype=np.intp)
        if self.run.options.mesh == "fixed":
            return whole
        spacing = graded_spacing(curve, self._resolution)
        if not (curve.edge_lengths > SPLIT * spacing).any():
            return whole
        return affordable_pieces(curve, spacing, self.most)


def with_growth(outcome: Outcome, run: Run) -> Outcome:
    """The outcome with a clause on how far lengths have come, if they were to change."""
    wanted = run.options.grow
    if wanted == 1.0:
        return outcome
    grew = "grew to {grown:.6g} of {wanted:.6g} times its length"
    return outcome.adding(grew, grown=run.iterate.grown, wanted=wanted)
