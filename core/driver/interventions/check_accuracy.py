"""The hierarchical solver's errors are looked at, against dense sums over a sample of edges, and kept within bounds."""

from dataclasses import replace

from ...curve import Mesh
from ...descent import NoStep
from ...energies.barrier import replaced_pairs
from ...hierarchy import HierarchicalMoebiusEnergy, SampledErrors
from ..events import Change, Event
from ..outcome import INACCURATE, TIGHTENED, Outcome
from ..run import Run


class CheckAccuracy:
    """Raise the order of expansions where it does not do, at the first look at a mesh and at the end."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._seen: Mesh | None = None

    def __call__(self, event: Event) -> Event | Change:
        """Look at every new mesh, and wherever the run may end."""
        problem = self._run.problem
        energy = problem.objective.energy
        ends = isinstance(event, NoStep | Outcome)
        if not isinstance(energy, HierarchicalMoebiusEnergy) or not (ends or problem.mesh is not self._seen):
            return event
        self._seen = problem.mesh
        self._run.sampled_errors = None
        if energy.block_list(self._run.point.curve).mostly_near:
            return event
        accurate = self._tightened(energy)
        if accurate is energy:
            return event
        objective = replace(problem.objective, energy=accurate)
        return Change(point=self._run.point.within(replace(problem, objective=objective)))

    def _tightened(self, energy: HierarchicalMoebiusEnergy) -> HierarchicalMoebiusEnergy:
        """The first of higher and higher order that is accurate enough, or the last one."""
        while True:
            self._run.sampled_errors = errors = self._errors(energy)
            tighter = energy.tightened
            if tighter is None or errors.within(self._run.options.accuracy):
                return energy
            energy = tighter

    def _errors(self, energy: HierarchicalMoebiusEnergy) -> SampledErrors:
        """At the present curve; near pairs that the barrier stands for are exact."""
        point = self._run.point
        energy = energy.leaving_out(replaced_pairs(point.curve))
        return SampledErrors.at(energy, point.curve, point.energy, point.gradient, point.gradient_norm)


def with_errors(outcome: Outcome, run: Run) -> Outcome:
    """What is told of a run's end, with what is known of the errors."""
    errors = run.sampled_errors
    if errors is None:
        return outcome
    outcome = replace(outcome, sampled_errors=errors)
    if errors.order > HierarchicalMoebiusEnergy.order:
        outcome = outcome.adding(TIGHTENED.format(order=errors.order))
    if errors.within(run.options.accuracy):
        return outcome
    return outcome.adding(INACCURATE.format(energy=errors.energy.bound, norm=errors.gradient_norm.bound))
