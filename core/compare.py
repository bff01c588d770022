"""Run several methods from the same start and keep what each did: the data behind Figure 3 of [RS21]."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from .collision import check_embedded
from .curve import Curve, check_is_curve
from .errors import OptionError
from .iterate import Status
from .options import RelaxOptions
from .relax import relax
from .setup import check_size, embedded_refinement, start_problem
from .units import check_units


@dataclass(frozen=True)
class Run:
    """One method's history.

    Attributes
    ----------
    method
        Its name.
    status
        "converged", "iteration_limit", "stalled", or "time_limit".
    seconds, energy, gradient_norm
        At every iterate, the start first; seconds since the method began, set-up left out.
    """

    method: str
    status: str
    seconds: tuple[float, ...]
    energy: tuple[float, ...]
    gradient_norm: tuple[float, ...]


def compare(curve: Curve, methods: Sequence[str], options: RelaxOptions, time_limit: float) -> Iterator[Run]:
    """Give one run per method, all from the same refined curve, each ended at ``time_limit`` seconds.

    Whether every method can be run is looked at before the first one is. Raises as `relax` does.
    """
    check_is_curve(curve)
    if isinstance(methods, str):
        raise OptionError(f"methods are {methods!r:.60}; give a list of names")
    for method in methods:
        check_size(curve, replace(options, method=method))
    check_units(curve)
    check_embedded(curve)
    start = embedded_refinement(curve, options.vertices)
    each = [replace(options, method=method, vertices=len(start)) for method in methods]
    for wanted in each:
        start_problem(start, wanted)
    return (_run(start, wanted, time_limit) for wanted in each)


def _run(start: Curve, options: RelaxOptions, time_limit: float) -> Run:
    seconds: list[float] = []
    energy: list[float] = []
    norm: list[float] = []
    status = "time_limit"
    began = time.perf_counter()
    for iterate in relax(start, options):
        now = time.perf_counter()
        if not seconds:
            began = now
        if iterate.index == len(seconds):  # a stalled run yields its last iterate twice
            seconds.append(now - began)
            energy.append(iterate.energy)
            norm.append(iterate.gradient_norm)
        if iterate.status is not Status.RUNNING:
            status = iterate.status.value
        elif now - began > time_limit:
            break
    return Run(options.method, status, tuple(seconds), tuple(energy), tuple(norm))
