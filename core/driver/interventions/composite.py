"""A composite curve has no shape of least energy: only the mesh keeps one of its parts from shrinking to a point."""

from ...curve import Curve
from ...hierarchy import moebius_energy
from ...knots.composite import Ball, knotted_ball
from ..events import Event
from ..outcome import COMPOSITE, Outcome, stalled
from ..run import Run
from .split_links import split

COMPOSITE_KNOT = 140.0  # less energy than any composite: two trefoils (74.4 each) less a circle make 144.8,
COMPOSITE_LINK = 90.0  # two Hopf links (47.5 each) 91


class Composite:
    """Say so where a converged curve is composite and its energy does not see size."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def __call__(self, event: Event) -> Event:
        """Look at converged curves."""
        problem = self._run.problem
        scale_invariant = problem.objective.energy.scale_exponent == 0.0
        may_shrink = scale_invariant and not len(problem.constraints.pins)  # between pins a part cannot without limit
        if not (isinstance(event, Outcome) and event.converged and may_shrink):
            return event
        for curve in split(self._run.iterate.curve, problem.constraints.parts):
            if (ball := _cutting_ball(curve)) is not None:
                center = ", ".join(f"{x:.3g}" for x in ball.center)
                return stalled(COMPOSITE.format(radius=ball.radius, center=center))
        return event


def _cutting_ball(curve: Curve) -> Ball | None:
    """A ball that proves a curve composite, looked for only where there is energy enough for that."""
    components = len(curve.mesh.component_sizes)
    if moebius_energy(curve)[0] < (COMPOSITE_KNOT if components == 1 else COMPOSITE_LINK):
        return None
    return knotted_ball(curve)
