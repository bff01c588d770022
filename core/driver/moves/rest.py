"""The end of a relaxation: to the last digits by second derivatives, with the index of the critical point.

A saddle is left downhill, where that is wanted.  Where the method finds no step another one takes over for a while, and
expansions of the hierarchical solver get a higher order where they do not suffice.
"""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ...base import Message
from ...curve import Curve, Mesh
from ...curve.symmetry import NO_SYMMETRY
from ...descent import METHODS, Method, NoStep, Point, Step, on_target, soft_modes
from ...descent.hessian import SoftModes, smooth_starts
from ...descent.second_order import Curvature, Newton, step_off
from ...energies.barrier import replaced_pairs
from ...energies.components import energy_scale
from ...energies.hierarchy import HierarchicalMoebiusEnergy, SampledErrors
from ...solve.metrics import MoebiusMetric
from ...solve.saddle.indefinite import FactorisedHessian
from ..move import Change, Event, Move
from ..outcome import Outcome
from .links import is_unresolved

MINIMUM = "a minimum"
SADDLE = "a saddle of index {index}"
ILL_CONDITIONED = "the Hessian is too ill-conditioned to tell a minimum from a saddle"


@dataclass(eq=False)
class Settle(Move):
    """On the last mesh second derivatives take over from L-BFGS until nothing is left to gain; they give the index."""

    newton: Newton = field(default_factory=Newton)
    loosest: float = 1e-4  # tolerance above which small gradients are all that is required
    gradient: float = 1e-3  # norm of the gradient, relative to √E, at which second derivatives take over
    exact: float = 1e-8  # gain that may be left, relative to E
    rounds: int = 6  # of steps at rest: in a curved valley, where these are short, they would never end
    trusted: float = 0.1  # largest σ: where more is needed, as on a ridge, L-BFGS goes on

    def __post_init__(self) -> None:
        self.started()

    def started(self) -> None:
        self._below, self._rounds = self.gradient, 0

    def stepped(self, step: Step) -> Change | None:
        point, mesh = self.run.point, self.run.options.mesh
        relative = point.gradient_norm / energy_scale(point.problem.mesh, point.energy) ** 0.5
        if relative > 10.0 * self.gradient:  # far from rest, as where a hand has pulled
            self.started()
        if relative > self._below or not self._applies or mesh == "adaptive":
            return None
        if self.run.options.ends_finer and is_unresolved(self.run.iterate.curve):
            return None
        self._below = 0.5 * relative  # in a curved valley these steps, which cost more than others, are no better
        try:
            curvature = Curvature(point)
            inverse, _, shift = self.newton.definite(curvature, unresolved(point.curve))
            steps = self._steps(curvature, inverse, shift) if shift <= self.trusted else ()
        except np.linalg.LinAlgError:
            return None
        return Change(steps) if steps else None

    def converged(self, outcome: Outcome) -> Outcome | Change | None:
        index: int | None
        point, symmetry = self.run.point, self.run.iterate.symmetry
        asked = self.run.options.stability or self.run.options.escape_saddles
        try:
            if self._applies:
                curvature, least = Curvature(point), self._least
                inverse, index, shift = self.newton.definite(curvature, unresolved(point.curve))
                if self._rounds < self.rounds and curvature.gain(inverse) > least:
                    self._rounds += 1
                    steps = self._steps(curvature, inverse, shift)
                    if steps and steps[-1].point.energy < point.energy - least:
                        return Change(steps)
            elif asked:
                index = stability(point).index
            else:
                return None
            if not symmetry:
                kinds = (_kind(index),) if index or asked else ()
                return replace(outcome, negative_eigenvalues=index, clauses=(*outcome.clauses, *kinds))
            free = replace(self.run.problem.constraints, symmetry=NO_SYMMETRY)
            whole = stability(point.changing(constraints=free)).index
        except np.linalg.LinAlgError:
            return None  # it is at rest, judged by its gradient
        outcome = replace(outcome, negative_eigenvalues=whole, symmetric_negative_eigenvalues=index)
        among = "{kind} among curves of symmetry {group}, {whole} among all"
        return outcome.adding(among, kind=_kind(index), group=symmetry, whole=_kind(whole))

    def _steps(self, curvature: Curvature, inverse: FactorisedHessian, shift: float) -> tuple[Step, ...]:
        return tuple(self.newton.along(curvature, inverse, shift, self.run.iterations_left, self._least))

    @property
    def _least(self) -> float:
        return self.exact * energy_scale(self.run.problem.mesh, self.run.point.energy)

    @property
    def _applies(self) -> bool:
        run, point = self.run, self.run.point
        free = point.problem.objective.pull is None
        usual = run.method is METHODS["lbfgs"] and point.problem.metric.name == MoebiusMetric.name
        at_once = run.options.tolerance <= self.loosest and not run.frozen and on_target(point)
        return usual and free and at_once and Curvature.is_known(point)


def _kind(index: int | None) -> Message:
    """The kind of critical point with an index, if that is known."""
    return Message(ILL_CONDITIONED) if index is None else Message(SADDLE, index=index) if index else Message(MINIMUM)


@dataclass(frozen=True, eq=False)
class Stability:
    """Second-order information at a critical point: D²E − Σ λ_I D²Φ_I on ker DΦ against J_C."""

    point: Point  # in the metric J_C

    @cached_property
    def zero(self) -> float:
        """Size up to which the mesh cannot distinguish an eigenvalue from 0."""
        return unresolved(self.point.curve)

    @cached_property
    def modes(self) -> SoftModes:
        """The lowest eigenvalues and eigenvectors, by some hundred products."""
        # residuals at which Ritz values count as eigenvalues: their errors are of the order of its square
        return soft_modes(self.point, smooth_starts(self.point, np.random.default_rng(1)), 1e-5)

    @cached_property
    def index(self) -> int | None:
        """Number of negative eigenvalues: 0 at a minimum, more at a saddle; None if they could not be computed."""
        if Curvature.is_known(self.point):
            return Curvature(self.point).shifted(self.zero).negative
        negative = int(np.count_nonzero(self.modes.values < -self.zero))
        return negative if (self.modes.residuals[: negative + 1] <= 1e-5).all() else None


def stability(point: Point) -> Stability:
    """The stability of a point, in the metric J_C whatever metric its problem has: eigenvalues are against J_C."""
    if point.problem.metric.name != MoebiusMetric.name:
        point = point.changing(metric=point.problem.solver.of_metric(MoebiusMetric()))
    return Stability(point)


def unresolved(curve: Curve) -> float:
    """Size of the eigenvalues of Möbius maps, which change the energy only through the mesh."""
    ell = curve.edge_lengths
    # rotations and sliding are flat directions; Möbius maps have at most 11 (h/L)² at knots, h the longest edge
    return max(1e-5, 20.0 * max(float(ell[s].max() / ell[s].sum()) ** 2 for s in curve.mesh.edge_slices))


@dataclass(eq=False)
class EscapeSaddle(Move):
    """Step off a saddle along its most negative direction."""

    def converged(self, outcome: Outcome) -> Outcome | Change | None:
        if not self.run.options.escape_saddles:
            return None
        found = stability(self.run.point)
        if not found.index:
            return None
        step = step_off(self.run.point, found.modes.vectors[0], float(found.modes.values[0]))
        return Change((step,)) if isinstance(step, Step) else outcome.adding("no step down from it was found")


@dataclass(eq=False)
class Fallback(Move):
    """Hand over to another method where no step is found, and back after some steps."""

    # its metric does not see how near strands are, and so does not hold them together
    method: Method = METHODS["flow-h3-2"]
    steps: int = 10  # number of steps it takes
    progress: float = 1e-6  # relative decrease of the energy without which another attempt is pointless
    _until: int = field(default=0, init=False)  # iterate at which the fallback hands back
    _tried_at: float = field(default=math.inf, init=False)  # energy at the last attempt on the present mesh

    def __post_init__(self) -> None:
        self._asked_for, self._mesh = self.run.method, self.run.problem.mesh

    def __call__(self, event: Event) -> Event | Change:
        run = self.run
        if run.problem.mesh is not self._mesh:
            self._mesh, self._tried_at = run.problem.mesh, math.inf
        stuck = isinstance(event, NoStep)
        if run.method is not self._asked_for:
            return Change(method=self._asked_for) if stuck or run.iterate.index >= self._until else event
        if not stuck or run.point.energy >= (1.0 - self.progress) * self._tried_at:
            return event
        most = run.problem.solver.of_metric(self.method.metric).most_vertices
        helps = run.problem.geometry.prescribes and self._asked_for.name not in (self.method.name, "paper")
        if not helps or len(run.point.vertices) > most:
            return event
        self._until, self._tried_at = run.iterate.index + self.steps, run.point.energy
        return Change(method=self.method)


@dataclass(eq=False)
class CheckAccuracy(Move):
    """Sample the hierarchical solver's errors on every mesh and at the end; raise its order if they are too large."""

    _seen: Mesh | None = field(default=None, init=False)

    def __call__(self, event: Event) -> Event | Change:
        problem = self.run.problem
        energy = problem.objective.energy
        ends = isinstance(event, NoStep | Outcome)
        if not isinstance(energy, HierarchicalMoebiusEnergy) or not (ends or problem.mesh is not self._seen):
            return event
        self._seen = problem.mesh
        self.run.sampled_errors = None
        if energy.block_list(self.run.point.curve).mostly_near:
            return event
        point, accurate = self.run.point, energy
        while True:  # until the order is accurate enough, or the highest
            # near pairs, which the barrier replaces, are exact
            replaced = problem.objective.barrier is not None
            far = accurate.leaving_out(replaced_pairs(point.curve)) if replaced else accurate
            errors = SampledErrors.at(far, point.curve, point.energy, point.gradient, point.gradient_norm)
            self.run.sampled_errors, tighter = errors, accurate.tightened
            if tighter is None or errors.within(self.run.options.accuracy):
                break
            accurate = tighter
        if accurate is energy:
            return event
        return Change(point=point.changing(objective=replace(problem.objective, energy=accurate)))

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome with the sampled errors and clauses about them."""
        errors = self.run.sampled_errors
        if errors is None:
            return outcome
        outcome = replace(outcome, sampled_errors=errors)
        if errors.order > HierarchicalMoebiusEnergy.order:
            tightened = "far-field expansions were raised to order {order} for the requested accuracy"
            outcome = outcome.adding(tightened, order=errors.order)
        if errors.within(self.run.options.accuracy):
            return outcome
        inaccurate = (
            "the hierarchical solver misses the requested accuracy: against dense sums over a sample its relative "
            "errors are up to {energy:.1g} in the energy and {norm:.1g} in the gradient norm; the dense solver has no "
            "such error"
        )
        return outcome.adding(inaccurate, energy=errors.energy.bound, norm=errors.gradient_norm.bound)
