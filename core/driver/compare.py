"""Run several methods from the same start and keep what each did: the data behind Figure 3 of [RS21]."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ..curve import Curve
from ..errors import OptionError
from .options import RelaxOptions
from .prepare import prepared_start, start_problem
from .relax import relax


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


def compare(curve: Curve, methods: Sequence[str], options: RelaxOptions, time_limit: float) -> Iterator[History]:
    """Give one run per method, all from the same refined curve, each ended at ``time_limit`` seconds.

    Whether every method can be run is looked at before the first one is. Raises as `relax` does.
    """
    if options.mesh == "auto":
        options = replace(options, mesh="fixed")  # steps are to be compared on one mesh
    if isinstance(methods, str):
        raise OptionError(f"methods are {methods!r:.60}; give a list of names")
    start = prepared_start(curve, options.vertices, [replace(options, method=method) for method in methods])
    each = [replace(options, method=method, vertices=len(start)) for method in methods]
    for wanted in each:
        start_problem(start, wanted)
    return (_run(start, wanted, time_limit) for wanted in each)


def _run(start: Curve, options: RelaxOptions, time_limit: float) -> History:
    status = "time_limit"
    rows: list[tuple[float, float, float]] = []
    fallback: list[int] = []
    relaxation = relax(start, options)
    began = time.perf_counter()
    while not rows or rows[-1][0] <= time_limit:
        try:
            iterate = next(relaxation)
        except StopIteration as end:
            status = end.value.status.value
            break
        rows.append((time.perf_counter() - began, iterate.energy, iterate.gradient_norm))
        fallback += [iterate.index] if iterate.method != options.method else []
    seconds, energy, norm = zip(*rows, strict=True)
    return History(options.method, status, seconds, energy, norm, tuple(fallback))
