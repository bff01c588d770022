"""Target lengths grow or shrink to a multiple of those of the start, as fast as what is in the way allows."""

from dataclasses import replace

import numpy as np

from ...constraints import weighted_barycenter
from ...curve import Curve
from ...curve.refine import affordable_pieces, subdivide
from ...curve.remesh import SPLIT, graded_spacing
from ...descent import Leg, NoStep, Point, Step
from ...descent.searches.normal_step import on_target
from ...descent.step import attempt
from ...energies.components import energy_scale
from ...errors import MobiusFlowError
from ...types import IntArray
from ...units import Units
from ..events import Change, Event
from ..outcome import CROWDED, GREW, Outcome
from ..prepare import check_refined, on_mesh
from ..run import Run
from .finer_mesh import FINEST

FASTEST, SLOWEST = 0.2, 0.01  # logarithmic change of the lengths in one motion; less is not worth an iteration
SLIGHTEST = 1e-9  # the same where greater lengths are out of reach: what is all but taut bows out by degrees
RISE = 0.25  # of the objective in one motion, by its scale: more is made by contacts that it takes long to relax from
SETTLED = 0.01  # decrease of the objective in a step, by its scale, from which on the next motion may come
LATER = 0.1  # factor of that after no motion was found
EDGES_PER_GAP = 2.0  # what is packed bends as narrowly as strands are near
EVEN_RATIO = 2.0  # of spacings to their median: where walls are near, as spacings do not see, it bends as narrowly, too
REACHED = 1e-9  # logarithm of what may be missing


class Grow:
    """Change the lengths, by motions that are proved like all others, where the steps between have settled."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._fastest, self._settled = FASTEST, SETTLED
        self._energy = np.inf  # after the last event
        self._resolution = replace(run.resolution, edges_per_gap=EDGES_PER_GAP)

    def __call__(self, event: Event) -> Event | Change:
        """Look at the start, at steps that gained little, and where the run would end with other lengths."""
        left = float(np.log(self._run.options.grow / self._run.iterate.grown))
        if abs(left) <= REACHED or (isinstance(event, Outcome) and not event.converged):
            return event
        if not (self._run.problem.obstacles or len(self._run.problem.constraints.pins)):
            return self._scaled(left)
        step = self._step(left) if self._is_due(event) else None
        if step is not None:
            self._energy = step.point.energy
            return Change((step,), self._resolved(step.point))
        return event.stalling(CROWDED) if isinstance(event, Outcome) else event

    def _is_due(self, event: Event) -> bool:
        """Whether there is nothing else to do, or the curve has its lengths and has all but come to rest."""
        before, self._energy = self._energy, self._run.point.energy
        if isinstance(event, NoStep | Outcome):
            return True
        gained = before - self._energy if isinstance(event, Step) else 0.0
        return on_target(self._run.point) and gained <= self._settled * energy_scale(
            self._run.problem.mesh, self._energy
        )

    def _scaled(self, left: float) -> Change:
        """With nothing in the way: the whole curve scaled about its barycenter."""
        start, problem, factor = self._run.iterate.curve, self._run.problem, float(np.exp(left))
        center = weighted_barycenter(start) / start.length
        end = start.with_vertices(center + factor * (start.vertices - center))
        proof = problem.free_motion(start.vertices, end.vertices)
        constraints = problem.constraints.scaled(factor, problem.mesh)
        step = Step((Leg(replace(problem, constraints=constraints).at_curve(end), proof),), 0.0, None)
        return Change((step,), self._resolved(step.point))

    def _step(self, left: float) -> Step | None:
        """The shortest motion in the metric to what can be had of the change that is left; None if it is nothing."""
        point, problem = self._run.point, self._run.problem
        space, change = point.tangent_space, float(np.clip(left, -self._fastest, self._fastest))
        slowest = min(SLOWEST, self._fastest)
        while abs(change) >= min(slowest, abs(left)):
            constraints = problem.constraints.scaled(np.exp(change), problem.mesh)
            base = point.within(replace(problem, constraints=constraints))
            aim = base.vertices - space.pseudo_inverse(base.residual)
            found = attempt(base, aim, np.zeros_like(base.residual), self._is_cheap, space)
            if isinstance(found, Leg):
                self._fastest, self._settled = min(2.0 * abs(change), FASTEST), SETTLED
                return Step((found,), 0.0, None)
            slowest = SLIGHTEST if found.trial is None and left > 0 else SLOWEST
            change *= 0.5
        self._settled *= LATER
        return None

    def _is_cheap(self, end: Point) -> bool:
        before = self._run.point.energy
        return end.energy - before <= RISE * energy_scale(end.problem.mesh, before)

    def _resolved(self, point: Point) -> Point | None:
        """The point on a mesh and in units for its length; None if the present ones do, or are all that there are."""
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
        spacing = np.minimum(spacing, EVEN_RATIO * np.median(spacing))
        if not (curve.edge_lengths > SPLIT * spacing).any():
            return whole
        return affordable_pieces(curve, spacing, FINEST)


def with_growth(outcome: Outcome, run: Run) -> Outcome:
    """What is told of a run's end, with how far lengths have come that were to change."""
    wanted = run.options.grow
    return outcome if wanted == 1.0 else outcome.adding(GREW.format(grown=run.iterate.grown, wanted=wanted))
