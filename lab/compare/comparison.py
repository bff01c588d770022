"""Run several methods from the same start and record what each did: the data behind Figure 3 of [RS21]."""

import math
import time
from collections.abc import Collection, Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import filter as matching
from itertools import pairwise, product

from ...core.base import BLAS, OptionError, TimeLimit, check_number, checked, choice
from ...core.curve import Curve
from ...core.descent import METHODS, Problem, Task
from ...core.driver.move import iterates
from ...core.driver.moves import ON_A_FIXED_MESH
from ...core.driver.options import RelaxOptions
from ...core.driver.prepare import start_problem
from ...core.driver.relax import WithOutcome, begin, within
from ...core.driver.solver import Solver
from ...core.solve.metrics import METRICS

_BEYOND = ("stability", "escape_saddles", "balance", "time_limit")
LEFT_OUT = ("mesh", "grow", "untangle", "radius", "symmetry", "hops", *_BEYOND)
"""Options of `relax` that a comparison has not: steps of methods are compared as they are, on one mesh."""


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
        return f"<History of {self.label}: {self.status} after {self.iterations} iterations, {self.energy[-1]:.9g}>"

    @property
    def iterations(self) -> int:
        return len(self.energy) - 1

    @property
    def label(self) -> str:
        """The method, and after a colon the metric, unless it is the method's own."""
        return self.method if METHODS[self.method].metric.name == self.metric else f"{self.method}:{self.metric}"

    @property
    def kind(self) -> str:
        """The method without a metric that is part of its name: ``flow`` of ``flow-l2``."""
        return self.method.removesuffix(f"-{METHODS[self.method].metric.name}")

    @property
    def rises(self) -> int:
        """Number of steps in which the energy rose: on the way to other lengths, or where they are penalised."""
        return sum(after > before + 1e-12 * abs(before) for before, after in pairwise(self.energy))


def variants(methods: Sequence[str], options: RelaxOptions) -> list[RelaxOptions]:
    """The options with each of some methods, by name or METHOD:METRIC; ``*`` in either stands for all that fit.

    Raises OptionError for unknown names.
    """
    return [
        replace(options, method=method, metric=metric)
        for name, _, wanted in (name.partition(":") for name in methods)
        for method, metric in product(
            matching(METHODS, name) or [name], (matching(METRICS, wanted) or [wanted]) if wanted else [options.metric]
        )
    ]


@checked
@BLAS.bounded()
def compare(
    curve: Curve | Task,
    methods: Sequence[str],
    options: RelaxOptions,
    time_limit: float,
    stages: Collection[int] = (),
) -> Generator[History, None, None]:
    """Run each method from the same refined curve for a limited number of seconds.

    Methods are those of `variants`.  All are checked before the first one runs.  Nothing but the method takes steps,
    and a fallback where it is stuck: no second derivatives end a run, no strands are moved, and the mesh stays.  Edges
    keep their lengths unless ``edge_lengths`` asks for others, on the way to which the energy may rise.  Curves are
    kept of the iterates with indices ``stages``, and of the last iterate in place of any that were not reached.  Raises
    as `relax` does, and OptionError for options that are `LEFT_OUT`.
    """
    check_number("time_limit", time_limit, 0.0, float("inf"))
    if not len(methods):
        raise OptionError(f"there are no methods to compare; {choice('', METHODS)}")
    given = {name: value for name in LEFT_OUT if (value := getattr(options, name)) != getattr(RelaxOptions, name)}
    if excess := [f"{name}={value!r}" for name, value in given.items() if value not in ("fixed", "never", "none")]:
        raise OptionError(f"{excess[0]} has no part in a comparison of methods, step by step on one mesh; leave it out")
    options = replace(options, mesh="fixed", untangle="never", radius="none")
    if options.edge_lengths == "auto":
        options = replace(options, edge_lengths="keep")
    each = variants(methods, options)
    runs = [(one.method, Solver(one).metric.name) for one in each]
    if len(set(runs)) < len(runs):
        raise OptionError(f"methods are {','.join(methods):.60}; give each of them once")
    for one in each:
        Solver(one).check_size(Task.of(curve).curve)
    task = Task.of(curve).refined(options.vertices)
    each = [replace(one, vertices=len(task.curve)) for one in each]
    problems = [start_problem(task, one) for one in each]
    return (_run(task, *pair, time_limit, stages) for pair in zip(each, problems, strict=True))


@BLAS.bounded()
def _run(start: Task, options: RelaxOptions, problem: Problem, time_limit: float, stages: Collection[int]) -> History:
    rows: list[tuple[float, float, float]] = []
    fallback: list[int] = []
    curves: dict[int, Curve] = {}
    spent = TimeLimit(math.inf, time.process_time)
    work = iterates(begin(start, options), ON_A_FIXED_MESH)
    run = WithOutcome(within(spent, within(TimeLimit(time_limit), work)))
    for iterate in run:
        curve, energy = iterate.curve, iterate.energy
        if not problem.geometry.prescribes:  # the objective common to all methods, computed while the clock is stopped
            energy = problem.objective.value(curve.with_vertices(problem.units.from_user(curve.vertices)))
        rows.append((spent.used, energy, iterate.gradient_norm))
        fallback += [iterate.index] if iterate.method != options.method else []
        if iterate.index in stages:
            curves[iterate.index] = curve
    if stages and max(stages) > iterate.index:
        curves[iterate.index] = curve
    assert run.outcome is not None, "the loop is through"
    seconds, energies, norms = zip(*rows, strict=True)
    status, metric = run.outcome.status.value, problem.metric.name
    return History(options.method, status, seconds, energies, norms, tuple(fallback), metric, curves)


def least_energy(runs: Sequence[History]) -> float:
    """The least energy of the methods that keep lengths (others solve another problem), or of all if none does."""
    keeping = [run for run in runs if METHODS[run.method].geometry.prescribes]
    return min(min(run.energy) for run in keeping or runs)
