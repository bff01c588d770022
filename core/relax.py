"""The one driver: `relax` yields the iterates of a relaxation, `minimize` runs it to its end."""

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from .adaptive import INTERVAL, adapt, graded_problem
from .collision import check_embedded
from .constraints import Constraints, weighted_barycenter
from .curve import Curve, refine
from .descent import METHODS, Method, NoStep, Point, Problem, State, Step
from .descent.escape import escape_step
from .energies import ENERGIES, MoebiusEnergy, Objective
from .errors import OptionError
from .iterate import Iterate, Status
from .metrics import METRICS, MoebiusMetric
from .options import RelaxOptions
from .stability import stability
from .types import FloatArray
from .units import Units

_Entry = TypeVar("_Entry")
LENGTHS_REACHED = 1e-6  # max |log ℓ/ℓ⁰| that a converged curve may have


@dataclass(frozen=True, eq=False)
class Result:
    """How a relaxation ended.

    Attributes
    ----------
    curve
        The last curve, in the user's units.
    status, message
        Why it ended, and the same in a sentence.
    energies
        The objective at every iterate, the start first.
    seconds
        Wall-clock time.
    certified
        Whether every motion from the (refined) start to the result was proved free of contact.
    edge_length_error
        max |log ℓ/ℓ⁰| over the edges.
    method
        Name of the method.
    negative_eigenvalues
        Of the Lagrangian's Hessian, if asked for: 0 at a minimum.
    """

    curve: Curve
    status: Status
    message: str
    energies: tuple[float, ...]
    seconds: float
    certified: bool
    edge_length_error: float
    method: str
    negative_eigenvalues: int | None

    def report(self) -> dict[str, object]:
        """The result as the plain values that ``--report`` writes."""
        return {
            "status": self.status.value,
            "message": self.message,
            "iterations": len(self.energies) - 1,
            "seconds": self.seconds,
            "energy": list(self.energies),
            "final_energy": MoebiusEnergy().value(self.curve),
            "vertices": len(self.curve),
            "components": len(self.curve.mesh.component_sizes),
            "max_edge_length_error": self.edge_length_error,
            "certified": self.certified,
            "method": self.method,
            "negative_eigenvalues": self.negative_eigenvalues,
        }


def relax(curve: Curve, options: RelaxOptions | None = None) -> Iterator[Iterate]:
    """Relax a curve: yield it refined, then every accepted step, the last with its final status.

    A run that cannot go on yields its last iterate once more, with status STALLED and an empty path.

    Parameters
    ----------
    curve
        An embedded polygon, in any units and place.
    options
        What is asked for.

    Raises
    ------
    CurveError
        If the curve touches itself or is degenerate; the message says where.
    OptionError
        If an option does not fit.
    """
    options = RelaxOptions() if options is None else options
    method = method_named(options.method)
    check_embedded(curve)
    refined = refine(curve, options.vertices)
    return _iterates(start_problem(refined, options), refined, method, options)


def minimize(
    curve: Curve, options: RelaxOptions | None = None, callback: Callable[[Iterate], None] | None = None
) -> Result:
    """Relax a curve to the end and return the result; a keyboard interrupt keeps the curve reached so far.

    ``callback`` gets every iterate.  Raises as `relax` does.
    """
    options = RelaxOptions() if options is None else options
    started = time.perf_counter()
    energies: list[float] = []
    last: Iterate | None = None
    try:
        for iterate in relax(curve, options):
            if last is None or iterate.index > last.index:
                energies.append(iterate.energy)
            last = iterate
            if callback is not None:
                callback(iterate)
    except KeyboardInterrupt:
        if last is None:
            raise
        last = replace(last, status=Status.INTERRUPTED, message="interrupted: the curve reached so far is kept")
    assert last is not None, "relax yields at least its start"
    return Result(
        curve=last.curve,
        status=last.status,
        message=last.message,
        energies=tuple(energies),
        seconds=time.perf_counter() - started,
        certified=last.certified,
        edge_length_error=last.edge_length_error,
        method=options.method,
        negative_eigenvalues=last.negative_eigenvalues,
    )


def method_named(name: str) -> Method:
    """Look a method up; an OptionError lists the known ones."""
    return _named(METHODS, "method", name)


def _named(table: Mapping[str, _Entry], kind: str, name: str) -> _Entry:
    if name not in table:
        raise OptionError(f"{kind} {name!r} is unknown; choose one of {', '.join(table)}")
    return table[name]


def start_problem(curve: Curve, options: RelaxOptions) -> Problem:
    """The problem of relaxing a refined curve: its lengths or equal ones, and its barycenter, are prescribed.

    Raises
    ------
    OptionError
        If an option names something unknown, or a method and an energy do not go together.
    """
    method = method_named(options.method)
    units = Units.of(curve)
    start = curve.with_vertices(units.from_user(curve.vertices))
    constraints = Constraints(_target_lengths(start, options), weighted_barycenter(start))
    objective = Objective(_named(ENERGIES, "energy", options.energy))
    second_order = method.second_order or options.stability or options.escape_saddles
    if second_order and not objective.has_hessian:
        raise OptionError(
            f"{method.name} with these options needs a second derivative; energy {options.energy} has none"
        )
    if (options.stability or options.escape_saddles) and method.penalty is not None:
        raise OptionError(f"stability is about constrained minima, but method {method.name} penalises lengths")
    metric = method.metric if options.metric is None else _named(METRICS, "metric", options.metric)
    if options.quadrature_points > 1:
        if not isinstance(metric, MoebiusMetric):
            raise OptionError(
                f"quadrature_points is {options.quadrature_points}; metric {metric.name!r} has no such rule"
            )
        metric = MoebiusMetric(options.quadrature_points)
    penalty = method.penalty
    if options.penalty is not None:
        if penalty is None:
            raise OptionError(f"penalty is {options.penalty}; method {method.name!r} keeps lengths and has no penalty")
        penalty = options.penalty
    return Problem(curve.mesh, objective, metric, constraints, units, penalty, extended=metric.name != "l2")


def _target_lengths(start: Curve, options: RelaxOptions) -> FloatArray:
    if options.edge_lengths == "keep":
        return start.edge_lengths
    return np.concatenate([np.full(s.stop - s.start, start.edge_lengths[s].mean()) for s in start.mesh.slices])


def _iterates(problem: Problem, start: Curve, method: Method, options: RelaxOptions) -> Iterator[Iterate]:
    if options.adaptive:
        problem = graded_problem(problem, start, options.vertices)
    iterate, point = _first(problem, start, 0)
    state = State()
    fresh = False  # whether the mesh has just been refined around edges that were stuck
    while True:
        iterate, way_down = _judged(point, iterate, options)
        yield iterate
        if iterate.status is not Status.RUNNING:
            return
        if way_down is not None:
            step, state = escape_step(point, *way_down), State()
        else:
            step, state = method.step(point, state)
        stuck = step.limited_by if isinstance(step, NoStep) else None
        if isinstance(step, NoStep) and (not options.adaptive or stuck is None or fresh):
            yield replace(iterate, status=Status.STALLED, message=f"stalled: {step.reason}", path=())
            return
        if isinstance(step, Step):
            point = step.point
            path = tuple(problem.units.to_user(vertices) for vertices in step.path)
            iterate = _iterate(problem, point, start.with_vertices(path[-1]), iterate.index + 1, step.size, path)
        fresh = stuck is not None
        if options.adaptive and (fresh or iterate.index % INTERVAL == 0):
            change = adapt(problem, iterate.curve, options.vertices, stuck)
            if change is not None:
                if isinstance(step, Step):
                    yield iterate
                # the last motion on the old mesh, then the same curve on the new one
                moved = problem.at(problem.units.from_user(change.moved))
                yield _iterate(
                    problem, moved, start.with_vertices(change.moved), iterate.index + 1, 0.0, (change.moved,)
                )
                problem, start = change.problem, change.curve
                iterate, point = _first(problem, start, iterate.index + 2)
                state = State(None, state.last_step)


def _first(problem: Problem, curve: Curve, index: int) -> tuple[Iterate, Point]:
    """The first iterate on a mesh, and its point."""
    point = problem.at(problem.units.from_user(curve.vertices))
    return _iterate(problem, point, curve, index, 0.0, ()), point


def _iterate(
    problem: Problem, point: Point, curve: Curve, index: int, step_size: float, path: tuple[FloatArray, ...]
) -> Iterate:
    return Iterate(
        index=index,
        curve=curve,
        energy=point.energy,
        gradient_norm=point.gradient_norm,
        step_size=step_size,
        path=path,
        certified=problem.certifiable,
        edge_length_error=problem.constraints.length_error(point.curve),
    )


def _judged(point: Point, iterate: Iterate, options: RelaxOptions) -> tuple[Iterate, tuple[FloatArray, float] | None]:
    """The iterate with its status, and from a saddle the way down: a direction and its negative curvature."""
    bound = options.tolerance * np.sqrt(abs(point.energy))
    feasible = point.problem.penalty is not None or iterate.edge_length_error <= LENGTHS_REACHED
    way_down = None
    if iterate.gradient_norm <= bound and feasible:
        message = f"converged: projected gradient {iterate.gradient_norm:.3g} ≤ {bound:.3g}"
        iterate = replace(iterate, status=Status.CONVERGED, message=message)
        if options.stability or options.escape_saddles:
            found = stability(point)
            kind = f"; a saddle with index {found.index}" if found.index else "; a minimum"
            iterate = replace(iterate, negative_eigenvalues=found.index, message=message + kind)
            if options.escape_saddles and found.index:
                iterate = replace(iterate, status=Status.RUNNING, message="")
                way_down = found.directions[0], float(found.eigenvalues[0])
    if iterate.status is not Status.CONVERGED and iterate.index >= options.max_iterations:
        message = f"stopped after {iterate.index} iterations, as asked for"
        iterate = replace(iterate, status=Status.ITERATION_LIMIT, message=message)
    return iterate, way_down
