"""Run several methods from the same start and record what each did: the data behind Figure 3 of [RS21]."""

import time
from collections.abc import Collection, Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..arguments import check_number, checked
from ..curve import Curve
from ..deadline import TimeLimit
from ..descent import METHODS, Problem
from ..errors import OptionError, choice
from ..task import Task
from ..threads import BLAS
from .loop import WithOutcome, within
from .options import RelaxOptions
from .prepare import start_problem
from .relax import relax
from .solver import Solver
from .trajectory import Iterate


@dataclass(frozen=True)
class History:
    """One method's history; what is recorded for every iterate begins with the start."""

    method: str
    status: str  #: the value of a `Status`
    seconds: tuple[float, ...]  #: processor time since the method began, without set-up
    energy: tuple[float, ...]  #: the objective, without the penalty that some methods add to it
    gradient_norm: tuple[float, ...]  #: norm of the gradient of the function that is minimised
    fallback: tuple[int, ...]  #: iterates reached by another method, because this one was stuck
    metric: str  #: name of the metric in which gradients were taken
    stages: Mapping[int, Curve] = field(default_factory=dict, compare=False)  #: curves of some iterates by their index

    def __repr__(self) -> str:
        return f"<History of {self.method}: {self.status} after {self.iterations} iterations, {self.energy[-1]:.9g}>"

    @property
    def iterations(self) -> int:
        return len(self.energy) - 1


@checked
@BLAS.bounded()
def compare(
    curve: Curve | Task,
    methods: Sequence[str],
    options: RelaxOptions,
    time_limit: float,
    stages: Collection[int] = (),
) -> Generator[History, None, None]:
    """Run each method from the same refined curve for a limited number of seconds of processor time.

    All methods are checked before the first one runs.  There are no strand moves, and the mesh ``auto`` means a fixed
    one, so that steps are compared on one mesh.  Curves are kept of the iterates with indices ``stages``, and of the
    last iterate in place of any that were not reached.  Raises as `relax` does.
    """
    check_number("time_limit", time_limit, 0.0, float("inf"))
    if not len(methods):
        raise OptionError(f"there are no methods to compare; {choice('', METHODS)}")
    if options.untangle == "always":
        raise OptionError("untangle='always' moves strands before any method does; leave it out to compare methods")
    options = replace(options, mesh="fixed" if options.mesh == "auto" else options.mesh, untangle="never")
    if len(set(methods)) < len(methods):
        raise OptionError(f"methods are {','.join(methods):.60}; give each of them once")
    each = [replace(options, method=method) for method in methods]
    for wanted in each:
        Solver(wanted).check_size(Task.of(curve).curve)
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
    """The objective common to all methods, computed while the clock is stopped."""
    if problem.geometry.prescribes:
        return iterate.energy
    curve = iterate.curve
    return problem.objective.value(curve.with_vertices(problem.units.from_user(curve.vertices)))


def least_energy(runs: Sequence[History]) -> float:
    """The least energy of the methods that keep lengths (others solve another problem), or of all if none does."""
    keeping = [run for run in runs if METHODS[run.method].geometry.prescribes]
    return min(min(run.energy) for run in keeping or runs)
