"""The adaptive mesh: when it changes, and the proof that nothing touches meanwhile."""

from dataclasses import replace

import numpy as np

from ...collision import Contact, survives_rounding
from ...curve import Curve
from ...curve.refine import Resolution
from ...curve.remesh import Remeshed, graded_spacing, needs_remesh, remesh, superfluous
from ...descent import Leg, Problem, Step
from ...messages import Message, joined
from ...types import FloatArray, IntArray
from ..events import Change, Event, Start
from ..outcome import Outcome
from ..run import Run

ADVICE = Message("a finer or an adaptive mesh may help")
INTERVAL = 5  # accepted steps between two looks at the mesh


class Remesh:
    """Change the mesh where neighbours are no longer nearer than strands, and around edges that are stuck."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._just_refined = False  # around edges that were stuck: once is enough

    def __call__(self, event: Event) -> Event | Change:
        """Look at the mesh now and then, and where no step was found."""
        if isinstance(event, Start | Outcome):
            return event
        if self._run.options.mesh != "adaptive":
            return event if isinstance(event, Step) else replace(event, reason=joined((event.reason, ADVICE), "; "))
        if isinstance(event, Step):
            self._just_refined = False
            due = self._run.iterate.index % INTERVAL == 0
            return (self._change(None) if due else None) or event
        if event.limited_by is None or self._just_refined:
            return event
        change = self._change(event.limited_by)
        self._just_refined = change is not None
        return change or event

    def _change(self, stuck: Contact | None) -> Change | None:
        """Another mesh; None if this one is good or must stay.

        Parameters
        ----------
        stuck
            What keeps edges from moving: the mesh around them is refined whether it needs it or not.
        """
        problem, curve, resolution = self._run.problem, self._run.iterate.curve, self._run.resolution
        pins = problem.constraints.pins.vertices
        spacing = graded_spacing(curve, resolution)
        if stuck is not None:
            edges = np.arange(curve.mesh.edges)
            for edge in stuck.edges:
                near = curve.mesh.index_distance(np.full_like(edges, edge), edges) <= 2
                spacing[near] = np.minimum(spacing[near], 0.5 * curve.edge_lengths[near])
        elif not needs_remesh(curve, spacing, pins):
            return None
        found = proved_remesh(problem, curve, resolution, superfluous(curve, spacing, pins), spacing)
        if found is None:
            return None
        step, remeshed = found
        lengths = remeshed.lengths / problem.units.scale
        constraints = replace(problem.constraints, lengths=lengths, pins=remeshed.pins)
        problem = replace(problem, mesh=remeshed.curve.mesh, constraints=constraints)
        return Change((step,), problem.at_curve(remeshed.curve))


def proved_remesh(
    problem: Problem, curve: Curve, resolution: Resolution, removable: IntArray, spacing: FloatArray
) -> tuple[Step, Remeshed] | None:
    """The last motion on the old mesh and the change to a new one, with as many collapses as are free of contact.

    None if doubles do not tell the vertices apart.
    """
    while True:
        change = remesh(curve, resolution, removable, spacing, problem.constraints.pins)
        free = problem.free_motion(curve.vertices, change.moved.vertices)
        if free.time == 1.0 or not len(removable):
            break
        assert free.contact is not None
        ends = [end[list(free.contact.edges)] for end in (curve.mesh.tails, curve.mesh.heads)]
        guilty = np.isin(removable, ends)
        removable = removable[~guilty] if guilty.any() else removable[:0]
    if not all(survives_rounding(each, problem.obstacles) for each in (change.moved, change.curve)):
        return None
    return Step((Leg(problem.at_curve(change.moved), free),), 0.0, None), change
