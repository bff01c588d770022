"""Basin hopping (Wales and Doye 1997): from minimum to lower minimum, by motions proved like all others."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from ..arguments import checked_fields, number
from ..curve import Curve
from ..diagrams import quick_invariants
from ..energies.components import energy_scale
from ..errors import CurveError
from ..knots import knot_type
from ..messages import Message
from ..types import FloatArray
from .hand import Hold
from .interventions import ON_A_FIXED_MESH
from .loop import Relaxation, descent, iterates, summarised
from .motions import MOTIONS, Motion
from .outcome import Outcome
from .run import Run
from .symmetric import Symmetrised
from .untangling import Untangling

IS_UNKNOT = Message("the curve is an unknot, and a circle has less energy")
MAY_BE_UNKNOT = Message(
    "the curve may be an unknot, for its Alexander polynomial is trivial, and a circle has less energy"
)
ROUND = 0.9  # of the area of the circle of the same length; even coarse and uneven circles have that much
MOST_VERTICES = 10_000  # for which the knot type is computed: a few seconds


def hopping(run: Run, hold: Hold | None = None, symmetrised: Symmetrised | None = None) -> Relaxation:
    """Yield the iterates of a relaxation, of strand moves and of hops; return how it ended.

    A hop is one iterate: its path is the motion and the relaxation that follows, down to less energy than the previous
    minimum has.  A run stopped between two iterates therefore has the lowest curve so far.
    """
    hops, strands = Hops(run), Untangling(run)
    yield run.iterate
    if symmetrised and (change := symmetrised.change(run)):
        yield from run.change(change)
    yield from strands.before_flow()
    outcome = yield from descent(run, hold=hold)
    stuck = run.iterate
    yield from strands.where_stuck(outcome)
    if run.iterate is not stuck:
        outcome = yield from descent(run, hold=hold)
    while hops.led_lower(outcome):
        yield run.iterate
        outcome = yield from descent(run, hold=hold)
    outcome = hops.summarised(strands.summarised(summarised(outcome, run)))
    return symmetrised.summarised(outcome) if symmetrised else outcome


@checked_fields
@dataclass(eq=False)
class Hops:
    """The hops of one run."""

    run: Run
    motions: Sequence[Motion] = MOTIONS  # with which hops begin, in turn
    # relative decrease of the objective that counts: vertices sliding along a curve change it by about as much
    gain: float = number(1e-3, most=1)

    def __post_init__(self) -> None:
        self._rng = np.random.default_rng(self.run.options.seed)
        self._tried = self._taken = 0

    def led_lower(self, outcome: Outcome) -> bool:
        """Try until a hop leads lower, and let the run take it; False if none does, or if nothing is lower."""
        run = self.run
        motions = [motion for motion in self.motions if motion.fits(run.point)]
        if run.frozen or not (outcome.may_be_left and motions):
            return False
        if run.problem.unconfined and is_circle(run.iterate.curve):
            return False
        while self._tried < run.options.hops and run.iterations_left > 0:
            below = run.iterate.energy - self.gain * energy_scale(run.problem.mesh, run.iterate.energy)
            if below < 0.0:  # arcs that are straight
                return False
            motion = motions[self._tried % len(motions)]
            self._tried += 1
            try:
                found = trial(run, motion, self._rng, below)
            except np.linalg.LinAlgError:
                continue
            lower = found.run.iterate.energy < below
            run.charged += found.iterations - lower  # the hop itself is one iterate
            if lower:
                run.hop(found.run.point, found.path, found.certified)
                self._taken += 1
                return True
        return False

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with clauses on what hops achieved, or might achieve."""
        if self._tried:
            outcome = outcome.adding(
                "hops that lowered the energy: {taken} of {tried}", taken=self._taken, tried=self._tried
            )
        run = self.run
        unknot = unknot_message(run.iterate.curve) if outcome.may_be_left and run.problem.unconfined else None
        if unknot is None:
            return outcome
        more = "{unknot}: more hops may reach it" if run.options.hops else "{unknot}: hops may reach it"
        return outcome.adding(more, unknot=unknot)


@dataclass(frozen=True, eq=False)
class Trial:
    """A motion out of a minimum, and the relaxation from where it ends."""

    run: Run  # the relaxation at its end, on the mesh and in the problem of the minimum that was left
    path: tuple[FloatArray, ...]  # ends of the straight legs of both, each (n, m), in the user's units
    certified: bool  # whether all of them were proved
    iterations: int  # steps of both


def trial(run: Run, motion: Motion, rng: np.random.Generator, below: float) -> Trial:
    """Leave the point that a run has reached, and relax on the same mesh until the objective is ``below`` a value.

    It ends earlier where the relaxation does, or where no iterations are left.  Raises LinAlgError where a curve on the
    way is too degenerate to be computed with.
    """
    steps = list(islice(motion(run.point, rng), run.iterations_left))
    path = [leg.end.placed for step in steps for leg in step.legs]
    start = run.iterate.curve.with_vertices(path[-1]) if path else run.iterate.curve
    relaxing = Run(run.problem, start, run.options, run.iterations_left - len(steps))
    for iterate in iterates(relaxing, ON_A_FIXED_MESH):
        path += iterate.path
        if iterate.energy < below:
            break
    certified = relaxing.iterate.certified and all(step.certified for step in steps)
    return Trial(relaxing, tuple(path), certified, len(steps) + relaxing.iterate.index)


def is_circle(curve: Curve) -> bool:
    """Whether a curve has one component and is a round circle, up to discretisation.

    It uses the isoperimetric inequality L² ≥ 4π |A| in any dimension, where A = ½ ∮ γ ∧ dγ is the bivector of the areas
    of the curve's projections; only a circle traversed once attains equality.
    """
    if len(curve.mesh.component_sizes) > 1:
        return False
    moments = (curve.midpoints - curve.midpoints.mean(axis=0)).T @ curve.edge_vectors
    area = np.linalg.norm(moments - moments.T) / np.sqrt(8.0)
    return bool(4.0 * np.pi * area > ROUND * curve.length**2)


def unknot_message(curve: Curve) -> Message | None:
    """Say that a curve is or may be an unknot though not a circle; None if it is a circle, knotted or a link."""
    alone = len(curve.mesh.component_sizes) == 1
    if not alone or curve.dimension != 3 or len(curve) > MOST_VERTICES or is_circle(curve):
        return None
    if not quick_invariants(curve).is_trivial:
        return None
    try:
        names = knot_type(curve).names
    except CurveError:  # a stuck curve may be so near to itself that no projection resolves which strand is in front
        names = ()
    if not names:
        return MAY_BE_UNKNOT
    return IS_UNKNOT if names == ("0_1",) else None
