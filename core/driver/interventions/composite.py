"""A composite curve has no shape of least energy: only the mesh keeps one of its parts from shrinking to a point."""

from dataclasses import replace

from ...curve import Curve
from ...hierarchy import moebius_energy
from ...knots.composite import is_searchable, knotted_ball
from ..events import Event
from ..outcome import Outcome
from ..run import Run
from .split_links import split

COMPOSITE = (
    "strands pull tight without limit: the curve is composite, knotted both inside and outside the ball of radius "
    "{radius:.3g} around ({center}), and has no shape of least energy"
)
UNTESTED = "whether the link is composite was not tested, as there are too many ways to divide it"
COMPOSITE_KNOT = 140.0  # less energy than any composite: two trefoils (74.4 each) less a circle make 144.8,
COMPOSITE_LINK = 90.0  # two Hopf links (47.5 each) 91


class Composite:
    """Say so where a converged curve is composite and its energy does not see size."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def __call__(self, event: Event) -> Event:
        """Look at converged curves."""
        problem = self._run.problem
        # between pins no part can shrink without limit
        may_shrink = not (problem.objective.sees_size or len(problem.constraints.pins))
        if not (isinstance(event, Outcome) and event.converged and may_shrink):
            return event
        parts = [part for part in split(self._run.iterate.curve, problem.constraints.parts) if _may_be_composite(part)]
        ball = next(filter(None, map(knotted_ball, parts)), None)
        if ball is not None:
            if not all(map(ball.is_clear_of, problem.obstacles)):
                return event  # around what stands still nothing shrinks to a point
            center = ", ".join(f"{x:.3g}" for x in ball.center)
            return replace(event.stalling(COMPOSITE, radius=ball.radius, center=center), unbounded=True)
        return event if all(map(is_searchable, parts)) else event.adding(UNTESTED)


def _may_be_composite(curve: Curve) -> bool:
    """Whether there is energy enough for that, in space, on closed components: arcs can be unknotted."""
    if curve.dimension != 3 or not curve.mesh.all_closed:
        return False
    components = len(curve.mesh.component_sizes)
    return moebius_energy(curve)[0] >= (COMPOSITE_KNOT if components == 1 else COMPOSITE_LINK)
