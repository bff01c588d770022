"""Run several methods from the same start and keep what each did: the data behind Figure 3 of [RS21]."""

import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..arguments import checked
from ..checks import check_number
from ..curve import Curve
from ..deadline import TimeLimit
from ..descent import METHODS, Problem
from ..errors import OptionError, choice
from ..system.threads import BLAS
from ..task import Task
from .loop import WithOutcome, within
from .options import RelaxOptions
from .prepare import start_problem
from .relax import relax
from .solver import check_size
from .trajectory import Iterate


@dataclass(frozen=True)
class History:
    """One method's history.

    Attributes
    ----------
    method
        Its name.
    status
        "converged", "iteration_limit", "stalled", or "time_limit".
    seconds, energy, gradient_norm
        At every iterate, the start first: seconds of processor time since the method began, set-up left out; the
        objective, without the penalty that some methods add to it; and the norm of the gradient of what is minimised.
    fallback
        Iterates to which another method led, because this one was stuck.
    metric
        Name of the metric that gradients were taken in.
    stages
        The curves of some iterates, by their index.
    """

    method: str
    status: str
    seconds: tuple[float, ...]
    energy: tuple[float, ...]
    gradient_norm: tuple[float, ...]
    fallback: tuple[int, ...]
    metric: str
    stages: Mapping[int, Curve] = field(default_factory=dict, compare=False)

    def __repr__(self) -> str:
        return f"<History of {self.method}: {self.status} after {self.iterations} iterations, {self.energy[-1]:.9g}>"

    @property
    def iterations(self) -> int:
        """How many iterations there were."""
        return len(self.energy) - 1


@checked
@BLAS.bounded()
def compare(
    curve: Curve | Task,
    methods: Sequence[str],
    options: RelaxOptions,
    time_limit: float,
    stages: Collection[int] = (),
) -> Iterator[History]:
    """Give one run per method, all from the same refined curve, each ended after so many seconds of processor time.

    Whether every method can be run is looked at before the first one is. The mesh ``auto`` is a fixed one here, so that
    steps are compared on one mesh. Of the iterates of indices ``stages`` curves are kept, of the last one in place of
    those that were not reached. Raises as `relax` does.
    """
    check_number("time_limit", time_limit, 0.0, float("inf"))
    if not len(methods):
        raise OptionError(f"there are no methods to compare; {choice('', METHODS)}")
    if options.mesh == "auto":
        options = replace(options, mesh="fixed")
    if len(set(methods)) < len(methods):
        raise OptionError(f"methods are {','.join(methods):.60}; give each of them once")
    each = [replace(options, method=method) for method in methods]
    for wanted in each:
        check_size(Task.of(curve).curve, wanted)
    task = Task.of(curve).refined(options.vertices)
    each = [replace(wanted, vertices=len(task.curve)) for wanted in each]
    problems = [start_problem(task, wanted) for wanted in each]
    return (_run(task, *pair, time_limit, stages) for pair in zip(each, problems, strict=True))


def _run(start: Task, options: RelaxOptions, problem: Problem, time_limit: float, stages: Collection[int]) -> History:
    rows: list[tuple[float, float, float]] = []
    fallback: list[int] = []
    curves: dict[int, Curve] = {}
    relaxation, limit = relax(start, options), TimeLimit(time_limit, time.process_time)
    run = WithOutcome(within(limit, relaxation))
    for iterate in run:
        rows.append((limit.used, _without_penalty(iterate, problem), iterate.gradient_norm))
        fallback += [iterate.index] if iterate.method != options.method else []
        if iterate.index in stages:
            curves[iterate.index] = iterate.curve
    if stages and max(stages) > iterate.index:
        curves[iterate.index] = iterate.curve
    assert run.outcome is not None, "the loop is through"
    seconds, energy, norm = zip(*rows, strict=True)
    return History(
        options.method, run.outcome.status.value, seconds, energy, norm, tuple(fallback), problem.metric.name, curves
    )


def _without_penalty(iterate: Iterate, problem: Problem) -> float:
    """The objective that all methods have in common; it is computed while no stopwatch runs."""
    if problem.geometry.prescribes:
        return iterate.energy
    curve = iterate.curve
    return problem.objective.value(curve.with_vertices(problem.units.from_user(curve.vertices)))


def least_energy(runs: Sequence[History]) -> float:
    """The least energy of methods that keep lengths, or of all if there are none: others solve another problem."""
    keeping = [run for run in runs if METHODS[run.method].geometry.prescribes]
    return min(min(run.energy) for run in keeping or runs)
