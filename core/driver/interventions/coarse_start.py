"""A curve of many vertices is untangled with few of them, which is faster, and gets them all back at the end."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...arguments import checked_fields, number
from ...collision import survives_rounding
from ...curve import Curve
from ...curve.pins import arcs
from ...curve.refine import Resolution, apportion, subdivide
from ...curve.remesh import graded_spacing, superfluous
from ...curve.smooth import smoothed
from ...descent import Leg, NoStep, Point, Problem, Step
from ...types import FloatArray, IntArray
from ..outcome import Outcome
from ..prepare import equal_lengths
from ..run import Change, Intervention
from .remesh import proved_remesh

PASS = WAY_BACK = 2  # iterations of each: a motion and a change of mesh


@checked_fields
@dataclass(eq=False)
class CoarseStart(Intervention):
    """Leave vertices out, as far as the gaps between strands allow; in the end bring all back, on a smooth curve."""

    min_vertices: int = number(1500)  # from which it is worthwhile
    min_gain: float = number(2.0, above=1)  # factor by which there must be fewer vertices at first
    min_iterations: int = number(30)  # the way there and back takes a dozen, and leaves some for untangling
    min_share: float = number(0.05, most=1)  # of the way to the smooth curve; with less the curve stays as it is
    _coarse: Curve | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._problem, constraints = self.run.problem, self.run.problem.constraints
        # whatever kept lengths from being equal at the start is gone in the end
        lengths = equal_lengths(self._problem.mesh, constraints.lengths, constraints.pins.vertices)
        self._lengths = self._problem.units.scale * lengths
        self._wanted = self._is_wanted()

    def started(self) -> Change | None:
        return self._coarser() if self._wanted else self._smoother()

    def stepped(self, step: Step) -> Change | None:
        return self._back(self.run.iterations_left <= WAY_BACK)

    def stuck(self, found: NoStep) -> Change | None:
        return self._back()

    def ended(self, outcome: Outcome) -> Change | None:
        return self._back()

    def _back(self, due: bool = True) -> Change | None:
        self._wanted = False
        return self._finest() if due and self._coarse is not None else None

    def _is_wanted(self) -> bool:
        options, curve = self.run.options, self.run.iterate.curve
        if self.run.iterate.index > 0:
            return False  # after a hop the curve is untangled already
        if options.mesh != "auto" or options.grow != 1.0 or options.edge_lengths not in ("auto", "equal"):
            return False
        if not self._problem.geometry.prescribes:
            return False  # lengths that are penalised would take the jump of the energy at once
        if len(curve) < self.min_vertices or options.max_iterations < self.min_iterations:
            return False
        return bool(self.min_gain * np.sum(curve.edge_lengths / graded_spacing(curve, Resolution())) <= len(curve))

    def _coarser(self) -> Change | None:
        """A pass that leaves out up to a third of the vertices; None if none can go, or too few iterations are left."""
        if self.run.iterations_left < PASS + WAY_BACK:
            return None
        curve, problem = self.run.iterate.curve, self.run.problem
        spacing = graded_spacing(curve, Resolution())
        unsplit = np.maximum(spacing, curve.edge_lengths)  # so that no arc has more vertices than in the end
        found = proved_remesh(problem, curve, Resolution(), superfluous(curve, spacing, _kept(problem)), unsplit)
        if found is None or len(found[1].curve) >= len(curve):
            return None
        step, remeshed = found
        self._coarse = remeshed.curve
        return Change((step,), problem.on(remeshed.curve))

    def _finest(self) -> Change | None:
        """The same curve with all vertices, in the problem of the start; None if rounding would make some coincide."""
        self._coarse = curve = self.run.iterate.curve
        pieces = np.empty(curve.mesh.edges, dtype=np.intp)
        coarse, fine = (arcs(each.mesh, _kept(each)) for each in (self.run.problem, self._problem))
        for arc, again in zip(coarse, fine, strict=True):
            pieces[arc] = apportion(curve.edge_lengths[arc], len(again))
        finest = subdivide(curve, pieces)
        if not survives_rounding(finest, self._problem.obstacles):
            self._coarse = None
            return None
        return Change(point=self.run.problem.on(finest, self._lengths))

    def _smoother(self) -> Change | None:
        """The motion to a smooth curve through the coarse vertices, as far as free; on the constraints if possible."""
        if self._coarse is None:
            return None
        start = self.run.iterate.curve
        pins = self.run.problem.constraints.pins
        old = pins.on(self._coarse).vertices
        way = smoothed(self._coarse, start.mesh, old, pins.vertices).vertices - start.vertices
        way[pins.vertices] = 0.0
        self._coarse = None
        # back on the constraints, unless that is too far
        restored = self._motion(way, lambda end: end.retract(end.vertices, np.zeros_like(end.residual)))
        return restored or self._motion(way, lambda end: end)

    def _motion(self, way: FloatArray, ending: Callable[[Point], Point | None]) -> Change | None:
        """The longest part of a way, with its end as ``ending`` makes it, that is free; None if that is hardly any."""
        problem, start = self.run.problem, self.run.iterate.curve
        share = 1.0
        while share > self.min_share:
            end = ending(problem.at_curve(start.with_vertices(start.vertices + share * way)))
            if end is None:
                return None
            proof = problem.free_motion(start.vertices, end.placed)
            if proof.time == 1.0:
                return Change((Step((Leg(end, proof),), 0.0, None),))
            share *= min(0.9, proof.time)
        return None


def _kept(problem: Problem) -> IntArray:
    """Pins, and the first vertices of their components: so arcs come in the same order on all meshes."""
    mesh, pins = problem.mesh, problem.constraints.pins.vertices
    return np.union1d(pins, mesh.offsets[mesh.component[pins]])
