"""Target lengths grow or shrink to a multiple of those of the start, as fast as what is in the way allows."""

from dataclasses import replace

import numpy as np

from ...constraints import weighted_barycenter
from ...curve import Curve
from ...curve.pins import free_edges
from ...curve.refine import affordable_pieces, subdivide
from ...curve.remesh import SPLIT, graded_spacing
from ...descent import Leg, NoStep, Point, Problem, Step
from ...descent.searches.normal_step import on_target
from ...descent.step import attempt
from ...errors import MobiusFlowError
from ...types import IntArray
from ...units import Units
from ..events import Change, Event, Start
from ..outcome import CROWDED, GREW, Outcome
from ..prepare import check_refined, on_mesh
from ..run import Run
from .finer_mesh import FINEST

import os
FASTEST = float(os.environ.get("FASTEST", 0.2))  # logarithmic change of lengths in one motion
SLOWEST = 1e-3  # that is worth an iteration
RISE = float(os.environ.get("RISE", 0.25))  # of the objective, relative to it, in one motion: more would be too near to contact to relax from
SETTLED = float(os.environ.get("SETTLED", 0.01))  # relative decrease of the objective in a step, from which on the next motion may come
SLOWER = 0.1  # factor of that where there was none
EDGES_PER_GAP = float(os.environ.get("EPG", 3.0))  # bends of what is packed are as narrow as gaps
REACHED = 1e-9  # logarithm of what is missing


class Grow:
    """Change the lengths, by motions that are proved like all others, where the steps between have settled."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._fastest, self._settled = FASTEST, SETTLED
        self._energy = np.inf  # after the last event
        self._resolution = replace(run.resolution, edges_per_gap=EDGES_PER_GAP)

    def __call__(self, event: Event) -> Event | Change:
        """Look at the start, after steps that gained little, and wherever the run would end without more length."""
        run = self._run
        left = float(np.log(run.options.grow / run.iterate.grown))
        ends = isinstance(event, Outcome) and not event.converged
        if abs(left) <= REACHED or ends or not self._is_due(event):
            return event
        if not (run.problem.obstacles or len(run.problem.constraints.pins)):
            return self._scaled(np.exp(left))
        step = self._step(left)
        if step is not None:
            self._energy, self._settled = step.point.energy, SETTLED
            return Change((step,), self._resolved(step.point))
        self._settled *= SLOWER
        return event.stalling(CROWDED) if isinstance(event, Outcome) else event

    def _is_due(self, event: Event) -> bool:
        run = self._run
        before, self._energy = self._energy, run.point.energy
        if isinstance(event, NoStep | Outcome):
            return True
        gained = before - self._energy if isinstance(event, Step) else 0.0
        return on_target(run.point) and gained <= self._settled * abs(self._energy)

    def _scaled(self, factor: float) -> Change:
        """With nothing in the way: the whole curve scaled, about its barycenter."""
        start, problem = self._run.iterate.curve, self._run.problem
        center = weighted_barycenter(start) / start.length
        end = start.with_vertices(center + factor * (start.vertices - center))
        proof = problem.free_motion(start.vertices, end.vertices)
        constraints = problem.constraints.scaled(factor, problem.mesh)
        step = Step((Leg(replace(problem, constraints=constraints).at_curve(end), proof),), 0.0, None)
        return Change((step,), self._resolved(step.point))

    def _step(self, left: float) -> Step | None:
        """The shortest motion in the metric to longer edges, as much longer as it can be made; None if it is hardly any."""
        point, problem = self._run.point, self._run.problem
        space, change = point.tangent_space, float(np.clip(left, -self._fastest, self._fastest))
        while abs(change) >= min(SLOWEST, abs(left)):
            constraints = problem.constraints.scaled(np.exp(change), problem.mesh)
            base = point.within(replace(problem, constraints=constraints))
            aim = base.vertices - space.pseudo_inverse(base.residual)
            found = attempt(base, aim, np.zeros_like(base.residual), self._is_cheap, space)
            if isinstance(found, Leg):
                self._fastest = min(2.0 * abs(change), FASTEST)
                return Step((found,), 0.0, None)
            change *= 0.5
        return None

    def _is_cheap(self, end: Point) -> bool:
        before = self._run.point.energy
        return end.energy - before <= RISE * abs(before)

    def _resolved(self, point: Point) -> Point | None:
        """The point on a mesh, and in units, that suit its length; None if the present ones do, or there are no others."""
        problem, curve = point.problem, point.curve.with_vertices(point.placed)
        pieces = self._pieces(curve)
        if pieces.max() == 1 and Units.of(curve).scale == problem.units.scale:
            return None
        lengths = np.repeat(problem.constraints.lengths / pieces, pieces) * problem.units.scale
        options = replace(self._run.options, vertices=None, mesh="fixed", edge_lengths=tuple(lengths.tolist()))
        finer = subdivide(curve, pieces) if pieces.max() > 1 else curve
        try:
            check_refined(curve, finer, problem.obstacles)
            return on_mesh(problem, finer, options)
        except MobiusFlowError:
            return None

    def _pieces(self, curve: Curve) -> IntArray:
        """Into how many each edge is to be split."""
        whole = np.ones(curve.mesh.edges, dtype=np.intp)
        if self._run.options.mesh == "fixed":
            return whole
        spacing = graded_spacing(curve, self._resolution)
        if not (curve.edge_lengths > SPLIT * spacing).any():
            return whole
        return affordable_pieces(curve, spacing, FINEST)


def with_growth(outcome: Outcome, run: Run) -> Outcome:
    """What is told of a run's end, with how far lengths have come that were to change."""
    wanted = run.options.grow
    return outcome if wanted == 1.0 else outcome.adding(GREW.format(grown=run.iterate.grown, wanted=wanted))
