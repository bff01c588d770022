"""Relaxations among symmetric curves: the exactly symmetric curve that a start is near to, and the proved way there."""

from dataclasses import dataclass

from ..collision import is_free, survives_rounding
from ..curve import Curve
from ..curve.refine import refined_alike
from ..descent import Leg, Step
from ..errors import CurveError
from ..messages import Message
from ..symmetry import TOLERANCE, Symmetry, SymmetryGroup, symmetries
from .outcome import Outcome
from .prepare import target_lengths
from .run import Change, Run

ASKED = 0.1  # radii of gyration by which a start may miss a symmetry that is asked for by name
BLOCKED = (
    "the straight way to the nearest curve with symmetry {group} is not free of contact, as where strands meet on an "
    "axis that no symmetric curve passes through; relax the curve a little before, or ask for another symmetry"
)
LACKING = (
    "the curve has no symmetry {group}: within {tolerance:g} radii of gyration its group is {own}; relax and balance "
    "it before, or ask for another symmetry"
)
KEPT = "symmetry {group} was kept, from which the start was {distance:.2g} radii of gyration away"
NONE = "symmetry {group}, so that there was none to keep"


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
            whole = symmetries(curve, ASKED)
            part = whole.subgroup(wanted)
            if part is None:
                raise CurveError(Message(LACKING, group=wanted, tolerance=ASKED, own=whole.name))
            group = part
        if len(group.elements) == 1:
            return cls(curve, curve, curve, Symmetry(), group)
        mean, symmetry, begins = group.symmetrised(curve, curve.mesh.component_sizes)
        start, end = refined_alike(curve, mean, tuple(-begin % 1.0 for begin in begins))
        free = is_free(start.mesh, start.vertices, end.vertices)
        if not (free and survives_rounding(start) and survives_rounding(end)):
            raise CurveError(Message(BLOCKED, group=group.name))
        return cls(start, end, mean, symmetry, group)

    def change(self, run: Run) -> Change | None:
        """The way to the symmetric curve, and its problem; None if there is no symmetry, or too few iterations."""
        if not len(self.symmetry):
            return None
        end = run.problem.at_curve(self.end)
        proof = run.problem.free_motion(self.start.vertices, self.end.vertices)
        lengths = target_lengths(self.mean, run.problem.constraints.pins.vertices, (), run.options)
        point = run.problem.on(self.mean, lengths, self.symmetry)
        change = Change((Step((Leg(end, proof),), 0.0, None),), point)
        return change if run.allows(change) else None

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with a clause about the group."""
        if len(self.symmetry):
            return outcome.adding(KEPT, group=self.group.name, distance=self.group.distance)
        return outcome.adding(NONE, group=self.group.name)
