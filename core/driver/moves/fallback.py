"""Where method or solver does not suffice: a fallback method takes over, and expansions get a higher order."""

import math
from dataclasses import dataclass, field, replace

from ...base.arguments import checked_fields, number
from ...curve import Mesh
from ...descent import METHODS, Method, NoStep
from ...energies.barrier import replaced_pairs
from ...energies.hierarchy import HierarchicalMoebiusEnergy, SampledErrors
from ..outcome import Outcome
from ..run import Change, Event, Move

INACCURATE = (
    "the hierarchical solver misses the requested accuracy: against dense sums over a sample its relative errors are "
    "up to {energy:.1g} in the energy and {norm:.1g} in the gradient norm; the dense solver has no such error"
)


@checked_fields
@dataclass(eq=False)
class Fallback(Move):
    """Hand over to another method where no step is found, and back after some steps."""

    # its metric does not see how near strands are, and so does not hold them together
    method: Method = METHODS["flow-h3-2"]
    steps: int = number(10)  # number of steps it takes
    progress: float = number(1e-6, most=1)  # relative decrease of the energy without which another attempt is pointless
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
        return outcome.adding(INACCURATE, energy=errors.energy.bound, norm=errors.gradient_norm.bound)
