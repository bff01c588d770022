"""Basin hopping (Wales and Doye 1997): from minimum to lower minimum, by random motions proved like all others."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from ...base import CurveError, FloatArray, Message
from ...collision import walk
from ...curve import Curve
from ...descent import Leg, Point, Step, attempt, soft_modes
from ...energies.components import energy_scale
from ...knots import knot_type
from ...knots.diagrams import quick_invariants
from ..move import Change, Move, iterates
from ..outcome import Outcome
from ..run import Run
from .links import SplitLinks
from .rest import CheckAccuracy, Fallback

IS_UNKNOT = Message("the curve is an unknot, and a circle has less energy")
MAY_BE_UNKNOT = Message(
    "the curve may be an unknot, for its Alexander polynomial is trivial, and a circle has less energy"
)

Field = Callable[[FloatArray], FloatArray]
"""Velocities at vertices; shapes (n, m) -> (n, m)."""


@dataclass(frozen=True)
class RandomMotion(ABC):
    """Move along random fields up to a random energy, within constraints; lengths are RMS in radii of gyration."""

    fields: int = 10
    distance: float = 1.0  # that the curve moves along each field
    stride: float = 0.1  # of a step at most, halved where a step is not accepted
    shortest: float = 5e-3  # step at which a field is given up
    # least and greatest ceiling for the energy of the curve, as multiples of the energy scale
    ceilings: tuple[float, float] = (2.0, 16.0)

    def fits(self, point: Point) -> bool:
        return point.problem.geometry.prescribes

    @abstractmethod
    def field(self, point: Point, rng: np.random.Generator) -> Field:
        """The next field."""

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield proved steps, each of which ends on the constraints."""
        multiple = math.exp(rng.uniform(*np.log(self.ceilings)))
        ceiling = energy_scale(point.problem.mesh, point.energy) * multiple
        for _ in range(self.fields):
            for step in self.along(point, self.field(point, rng), ceiling):
                yield step
                point = step.point.anchored

    def along(self, point: Point, field: Field, ceiling: float) -> Iterator[Step]:
        """Yield steps along a field, each of which ends on the constraints and below a level of energy."""
        base = point

        def moved(_: float, stride: float) -> Leg | None:
            velocity = field(base.vertices)
            u = base.tangent_space.project(velocity)
            # all else is rounding: pins may leave nothing to move
            if root_mean_square(u) <= 1e-12 * root_mean_square(velocity):
                return None
            u *= stride * radius(base.vertices) / root_mean_square(u)
            found = attempt(base, base.vertices + u, 0.0 * base.residual, lambda end: end.energy < ceiling)
            return found if isinstance(found, Leg) else None

        for _, leg in walk(moved, self.distance, self.stride, self.shortest):
            yield Step((leg,), 0.0, None)
            base = leg.end.anchored


@dataclass(frozen=True)
class Push(RandomMotion):
    """Push along random soft modes, which slide touching strands along each other; flows would press them together."""

    fields: int = 3
    stride: float = 0.05  # where strands touch, only short steps are free
    shortest: float = 1e-3
    modes: int = 6  # number of modes in a combination
    # with the Hessian, to find the modes: soft enough by then, they need not converge any further. From a single
    # start, only one of all rotations and other flat directions can be among them
    products: int = 30

    def fits(self, point: Point) -> bool:
        """Whether, in addition, the energy has a second derivative."""
        return super().fits(point) and point.problem.objective.without_hessian is None

    def field(self, point: Point, rng: np.random.Generator) -> Field:
        start = point.tangent_space.project(rng.normal(size=point.vertices.size).reshape(point.vertices.shape))
        modes = soft_modes(point, start[None], 0.0, -math.inf, self.products).vectors[: self.modes]
        u = np.tensordot(rng.normal(size=len(modes)), modes, 1)
        return lambda _: u


@dataclass(frozen=True)
class Stir(RandomMotion):
    """Stir space by random flows, which fold the curve and turn it over.

    A single flow is an isotopy that keeps neighbouring strands together; a sequence of flows mixes them, and a higher
    ceiling lets the curve forget more of the minimum.
    """

    waves: int = 4  # number of plane waves that a flow is the sum of
    # standard deviation of each component of their wave vectors, in radians per radius of gyration
    frequency: float = 2.0

    def field(self, point: Point, rng: np.random.Generator) -> Field:
        """A sum of plane waves, each without divergence, most of them shorter than the curve is wide."""
        center = point.vertices.mean(axis=0)
        waves, amplitudes = rng.normal(size=(2, self.waves, point.vertices.shape[1]))
        along = np.sum(waves * amplitudes, axis=1) / np.square(waves).sum(axis=1)
        amplitudes -= along[:, None] * waves
        waves *= self.frequency / radius(point.vertices)
        phases = rng.uniform(0.0, 2.0 * np.pi, self.waves)
        return lambda x: np.asarray(np.sin((x - center) @ waves.T + phases) @ amplitudes)


def radius(vertices: FloatArray) -> float:
    """Radius of gyration."""
    return root_mean_square(vertices - vertices.mean(axis=0))


def root_mean_square(u: FloatArray) -> float:
    """The root mean square of the lengths of vectors, shape (n, m)."""
    return float(np.sqrt(np.square(u).sum(axis=1).mean()))


MOTIONS: tuple[RandomMotion, ...] = (Push(), Stir())
"""In the order of their turns."""

ON_A_FIXED_MESH: Sequence[Callable[[Run], Move]] = (SplitLinks, Fallback, CheckAccuracy)
"""The moves in a trial, which neither changes the mesh nor looks for more at its end."""


@dataclass(eq=False)
class Hops(Move):
    """Leave the place where a run would end by a motion, and relax from there, if that leads lower.

    A hop is one iterate: its path is the motion and the relaxation that follows, down to less energy than the previous
    minimum has.  A run stopped between two iterates therefore has the lowest curve so far.
    """

    lasts = True  # hops are counted from the start on
    motions: Sequence[RandomMotion] = MOTIONS  # with which hops begin, in turn
    # relative decrease of the objective that counts: vertices sliding along a curve change it by about as much
    gain: float = 1e-3
    _tried: int = field(default=0, init=False)
    _taken: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self._rng = np.random.default_rng(self.run.options.seed)

    def ended(self, outcome: Outcome) -> Change | None:
        """Try until a hop leads lower; None if none does, or if nothing is lower."""
        run = self.run
        if not run.options.hops or run.frozen or not outcome.may_be_left:
            return None
        motions = [motion for motion in self.motions if motion.fits(run.point)]
        if not motions or (run.problem.unconfined and is_circle(run.iterate.curve)):
            return None
        while self._tried < run.options.hops and run.iterations_left > 0:
            below = run.iterate.energy - self.gain * energy_scale(run.problem.mesh, run.iterate.energy)
            if below < 0.0:  # arcs that are straight
                return None
            motion = motions[self._tried % len(motions)]
            self._tried += 1
            try:
                change = self.hop(motion, below)
            except np.linalg.LinAlgError:  # a curve on the way is too degenerate to be computed with
                continue
            if change is not None:
                self._taken += 1
                return change
        return None

    def hop(self, motion: RandomMotion, below: float) -> Change | None:
        """Move, and relax on the same mesh until the objective is ``below`` a value; None if the trial ends before."""
        run = self.run
        steps = list(islice(motion(run.point, self._rng), run.iterations_left))
        path = [leg.end.placed for step in steps for leg in step.legs]
        start = run.iterate.curve.with_vertices(path[-1]) if path else run.iterate.curve
        trial = Run(run.problem, start, run.options, run.iterations_left - len(steps))
        for iterate in iterates(trial, ON_A_FIXED_MESH):
            path += iterate.path
            if iterate.energy < below:
                break
        run.charged += len(steps) + trial.iterate.index
        if not trial.iterate.energy < below:
            return None
        run.charged -= 1  # the hop itself is an iterate
        run.restart()
        certified = trial.iterate.certified and all(step.certified for step in steps)
        return Change(iterates=(run.go(trial.point, tuple(path), certified),), anew=True)

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


def is_circle(curve: Curve) -> bool:
    """Whether a curve has one component and is a round circle, up to discretisation.

    It uses the isoperimetric inequality L² ≥ 4π |A| in any dimension, where A = ½ ∮ γ ∧ dγ is the bivector of the areas
    of the curve's projections; only a circle traversed once attains equality.
    """
    if len(curve.mesh.component_sizes) > 1:
        return False
    moments = (curve.midpoints - curve.midpoints.mean(axis=0)).T @ curve.edge_vectors
    area = np.linalg.norm(moments - moments.T) / np.sqrt(8.0)
    # even coarse and uneven circles have that much of the area of a circle of the same length
    return bool(4.0 * np.pi * area > 0.9 * curve.length**2)


def unknot_message(curve: Curve) -> Message | None:
    """Say that a curve is or may be an unknot though not a circle; None if it is a circle, knotted or a link."""
    alone = len(curve.mesh.component_sizes) == 1
    # of more vertices the type takes more than a few seconds
    if not alone or curve.dimension != 3 or len(curve) > 10_000 or is_circle(curve):
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
