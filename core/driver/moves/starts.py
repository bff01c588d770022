"""Starts on other meshes: a symmetric one, and one of few vertices, which is faster where strands are tangled.

All vertices come back at the end.
"""

from dataclasses import dataclass, field

import numpy as np

from ...base import CurveError, IntArray, Message
from ...collision import is_free, survives_rounding
from ...curve import Curve, Resolution, arcs, graded_spacing, refined_alike, smoothed, subdivide
from ...curve.refine import apportion, superfluous
from ...curve.symmetry import TOLERANCE, Symmetry, SymmetryGroup, symmetries
from ...descent import Leg, NoStep, Problem, Step, leg
from ..move import Change, Move
from ..outcome import Outcome
from ..prepare import equal_lengths, target_lengths
from .remesh import proved_remesh

BLOCKED = (
    "the straight way to the nearest curve with symmetry {group} is not free of contact, as where strands meet on an "
    "axis that no symmetric curve passes through; relax the curve a little before, or ask for another symmetry"
)
LACKING = (
    "the curve has no symmetry {group}: within {tolerance:g} times its size its group is {own}; relax and balance "
    "it before, or ask for another symmetry"
)


@dataclass(frozen=True, eq=False)
class Symmetrised:
    """A start, refined, and the exactly symmetric curve that is its mean over a group.

    Both ``start`` and ``end`` have the vertices of the refined start and those of ``mean`` on their edges.
    """

    start: Curve
    end: Curve
    mean: Curve
    symmetry: Symmetry
    group: SymmetryGroup

    @classmethod
    def of(cls, curve: Curve, wanted: str) -> "Symmetrised":
        """The symmetrised curve under the whole group of a curve, "auto", or under the subgroup of a name.

        Raises CurveError if the curve does not have that symmetry, or is not free to move to the symmetric curve.
        """
        if wanted == "auto":
            group = symmetries(curve, TOLERANCE)
        else:
            # radii of gyration by which a start may miss a symmetry that is asked for by name
            whole = symmetries(curve, 0.1)
            part = whole.subgroup(wanted)
            if part is None:
                raise CurveError(Message(LACKING, group=wanted, tolerance=0.1, own=whole.name))
            group = part
        if len(group.elements) == 1:
            return cls(curve, curve, curve, Symmetry(), group)
        mean, symmetry, begins = group.symmetrised(curve, curve.mesh.component_sizes)
        start, end = refined_alike(curve, mean, tuple(-begin % 1.0 for begin in begins))
        free = is_free(start.mesh, start.vertices, end.vertices)
        if not (free and survives_rounding(start) and survives_rounding(end)):
            raise CurveError(Message(BLOCKED, group=group.name))
        return cls(start, end, mean, symmetry, group)


@dataclass(eq=False)
class SymmetricStart(Move):
    """Go from the start to the nearest symmetric curve, whose symmetry is kept from there on."""

    symmetrised: Symmetrised

    def started(self) -> Change | None:
        run, symmetrised = self.run, self.symmetrised
        if not len(symmetrised.symmetry) or run.iterate.index > 0:
            return None
        way = leg(run.point, run.problem.at_curve(symmetrised.end))
        lengths = target_lengths(symmetrised.mean, run.problem.constraints.pins.vertices, (), run.options)
        point = run.problem.on(symmetrised.mean, lengths, symmetrised.symmetry)
        return Change((Step((way,), 0.0, None),), point, anew=True)

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with a clause about the group."""
        group = self.symmetrised.group
        if not len(self.symmetrised.symmetry):
            return outcome.adding("symmetry {group}, so that there was none to keep", group=group.name)
        kept = "symmetry {group} was kept, which the start missed by {distance:.2g} times its size"
        return outcome.adding(kept, group=group.name, distance=group.distance)


@dataclass(eq=False)
class CoarseStart(Move):
    """Leave vertices out, as far as the gaps between strands allow; in the end bring all back, on a smooth curve."""

    min_vertices: int = 1500  # from which it is worthwhile
    min_gain: float = 2.0  # factor by which there must be fewer vertices at first
    min_iterations: int = 30  # the way there and back takes a dozen, and leaves some for untangling
    min_share: float = 0.05  # of the way to the smooth curve; with less the curve stays as it is
    _coarse: Curve | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._problem, constraints = self.run.problem, self.run.problem.constraints
        # whatever kept lengths from being equal at the start is gone in the end
        lengths = equal_lengths(self._problem.mesh, constraints.lengths, constraints.pins.vertices)
        self._lengths = self._problem.units.scale * lengths
        options, curve = self.run.options, self.run.iterate.curve
        self._wanted = (
            self.run.iterate.index == 0  # after a hop the curve is untangled already
            and (options.mesh, options.grow) == ("auto", 1.0)
            and options.edge_lengths in ("auto", "equal")
            and self._problem.geometry.prescribes  # lengths that are penalised would take the energy's jump at once
            and len(curve) >= self.min_vertices
            and options.max_iterations >= self.min_iterations
            and self.min_gain * np.sum(curve.edge_lengths / graded_spacing(curve, Resolution())) <= len(curve)
        )

    def started(self) -> Change | None:
        curve, problem = self.run.iterate.curve, self.run.problem
        if self._wanted:
            if self.run.iterations_left < 4:  # a motion and a change of mesh, both there and back
                return None
            spacing = graded_spacing(curve, Resolution())
            unsplit = np.maximum(spacing, curve.edge_lengths)  # so that no arc has more vertices than in the end
            # a pass leaves out up to a third of the vertices
            found = proved_remesh(problem, curve, superfluous(curve, spacing, _kept(problem)), unsplit)
            if found is None or len(found[1]) >= len(curve):
                return None
            step, self._coarse = found
            return Change((step,), problem.on(self._coarse))
        if self._coarse is None:
            return None
        # all vertices are back: the motion to a smooth curve through the coarse ones, as far as free
        pins, coarse, self._coarse = problem.constraints.pins, self._coarse, None
        way = smoothed(coarse, curve.mesh, pins.on(coarse).vertices, pins.vertices).vertices - curve.vertices
        way[pins.vertices] = 0.0
        for restores in (True, False):  # back on the constraints, unless that is too far
            share = 1.0
            while share > self.min_share:
                there = problem.at_curve(curve.with_vertices(curve.vertices + share * way))
                end = there.retract(there.vertices, np.zeros_like(there.residual)) if restores else there
                if end is None:
                    break
                proof = problem.free_motion(curve.vertices, end.placed)
                if proof.time == 1.0:
                    return Change((Step((Leg(end, proof),), 0.0, None),))
                share *= min(0.9, proof.time)
        return None

    def stepped(self, step: Step) -> Change | None:
        return self._back(self.run.iterations_left <= 2 or not self.run.makes_headway)

    def stuck(self, found: NoStep) -> Change | None:
        return self._back()

    def ended(self, outcome: Outcome) -> Change | None:
        return self._back()

    def _back(self, due: bool = True) -> Change | None:
        """The same curve with all vertices, in the problem of the start; None if rounding would make some coincide."""
        self._wanted = False
        if not due or self._coarse is None:
            return None
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


def _kept(problem: Problem) -> IntArray:
    """Pins, and the first vertices of their components: so arcs come in the same order on all meshes."""
    mesh, pins = problem.mesh, problem.constraints.pins.vertices
    return np.union1d(pins, mesh.offsets[mesh.component[pins]])
