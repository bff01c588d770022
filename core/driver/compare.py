"""Run several methods from the same start and keep what each did: the data behind Figure 3 of [RS21]."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ..curve import Curve
from ..errors import OptionError
from ..system.threads import BLAS
from ..task import Task
from .loop import WithOutcome
from .options import RelaxOptions
from .prepare import start_problem
from .relax import relax
from .solver import check_size


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
        At every iterate, the start first; seconds since the method began, set-up left out.
    fallback
        Iterates to which another method led, because this one was stuck.
    """

    method: str
    status: str
    seconds: tuple[float, ...]
    energy: tuple[float, ...]
    gradient_norm: tuple[float, ...]
    fallback: tuple[int, ...]


@BLAS.bounded()
def compare(given: Task | Curve, methods: Sequence[str], options: RelaxOptions, time_limit: float) -> Iterator[History]:
    """Give one run per method, all from the same refined curve, each ended at ``time_limit`` seconds.

    Whether every method can be run is looked at before the first one is. The mesh ``auto`` is a fixed one here, so that
    steps are compared on one mesh. Raises as `relax` does.
    """
    if options.mesh == "auto":
        options = replace(options, mesh="fixed")
    if isinstance(methods, str):
        raise OptionError(f"methods are {methods!r:.60}; give a list of names")
    if len(set(methods)) < len(methods):
        raise OptionError(f"methods are {','.join(methods):.60}; give each of them once")
    each = [replace(options, method=method) for method in methods]
    for wanted in each:
        check_size(Task.of(given).curve, wanted)
    task = Task.of(given).refined(options.vertices)
    each = [replace(wanted, vertices=len(task.curve)) for wanted in each]
    for wanted in each:
        start_problem(task, wanted)
    return (_run(task, wanted, time_limit) for wanted in each)


def _run(start: Task, options: RelaxOptions, time_limit: float) -> History:
    rows: list[tuple[float, float, float]] = []
    fallback: list[int] = []
    run = WithOutcome(relax(start, options))
    began = time.perf_counter()
    for iterate in run:
        rows.append((time.perf_counter() - began, iterate.energy, iterate.gradient_norm))
        fallback += [iterate.index] if iterate.method != options.method else []
        if rows[-1][0] > time_limit:
            break
    status = "time_limit" if run.outcome is None else run.outcome.status.value
    seconds, energy, norm = zip(*rows, strict=True)
    return History(options.method, status, seconds, energy, norm, tuple(fallback))
