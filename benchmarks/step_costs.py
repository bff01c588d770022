"""What an iteration costs: processor time phase by phase, memory, and how far the hierarchical solver is off.

Times are processor time, all threads together, so that other programs count for little; what remains of the machine
is its speed, represented by the times of two plain operations.
"""

import time
import tracemalloc
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import fmean, median

import numpy as np
from hard_curves import bent_trefoil
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, Task
from mobius_flow.core.base.threads import BLAS
from mobius_flow.core.descent import NoStep, Point, Step
from mobius_flow.core.descent.methods import METRIC_STEPS
from mobius_flow.core.descent.step import leg
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.energies.barrier import near_pairs
from mobius_flow.core.energies.hierarchy import HierarchicalMoebiusEnergy

MAX_COMPARED = 3000  # vertices up to which the hierarchical solver is compared with the dense one
ASYMPTOTIC = 2000  # vertices from which times are expected to follow a power law
ROUNDS = 5  # the median counts
GROUPS = 3  # of METRIC_STEPS iterations each: methods that keep their metric that long build it once per group
PRODUCT = 1000  # rows of the matrices whose product is timed
COPY = 100_000_000  # bytes


@dataclass(frozen=True)
class Machine:
    """Seconds for a product of two 1000 × 1000 matrices (dgemm), and for a copy of 100 MB in memory."""

    product: float
    copy: float

    @classmethod
    def measured(cls) -> "Machine":
        """Measure this machine as it is now."""
        matrix = np.random.default_rng(1).normal(size=(PRODUCT, PRODUCT))
        product = np.empty_like(matrix)
        source = np.ones(COPY // matrix.itemsize)
        target = source.copy()
        return cls(
            median(_seconds(lambda: np.matmul(matrix, matrix, out=product)) for _ in range(ROUNDS)),
            median(_seconds(lambda: np.copyto(target, source)) for _ in range(ROUNDS)),
        )


@dataclass(frozen=True)
class Deviation:
    """How far the hierarchical solver is from the dense one.

    Attributes
    ----------
    energy
        Relative error of the objective.
    derivative
        Relative error of the projected gradient, in the norm of the dense J, that comes from its derivative alone: what
        may move minimisers.
    cosine
        Of the angle between the two projected gradients, in the dense J.
    norm
        Relative error of the projected gradient's norm in the dense J. This and the angle arise mostly because the
        compressed J is another inner product, which changes nothing but the path.
    """

    energy: float
    derivative: float
    cosine: float
    norm: float


@dataclass(frozen=True)
class Row:
    """The figures of one size.

    Attributes
    ----------
    vertices
        The size.
    solver
        "dense" or "hierarchical".
    seconds
        Processor time of each phase of a step, and of a whole iteration, by name.
    peak_bytes
        Most memory at one time, from the start of a run to the end of its first iteration.
    deviation
        From the dense solver; None where this is the solver, or there are too many vertices for it.
    """

    vertices: int
    solver: str
    seconds: Mapping[str, float]
    peak_bytes: int
    deviation: Deviation | None


def speed(sizes: Sequence[int], options: RelaxOptions) -> Iterator[Row]:
    """Measure one size after the other, with options whose mesh is fixed."""
    for size in sizes:
        yield _row(bent_trefoil(size), replace(options, vertices=size))


def exponents(rows: Sequence[Row]) -> dict[str, float]:
    """For each solver the p of seconds ~ Nᵖ for whole iterations, by least squares in the logarithms.

    From N = 2000 on; solvers with fewer than two such sizes are left out.
    """
    large = [row for row in rows if row.vertices >= ASYMPTOTIC]
    fits = {}
    for solver in sorted({row.solver for row in large}):
        points = [(row.vertices, row.seconds["iteration"]) for row in large if row.solver == solver]
        if len(points) > 1:
            x, y = np.log(points).T
            fits[solver] = float(np.polyfit(x, y, 1)[0])
    return fits


@BLAS.bounded()
def _row(curve: Curve, options: RelaxOptions) -> Row:
    run = _started(curve, options)
    hierarchical = isinstance(run.problem.objective.energy, HierarchicalMoebiusEnergy)
    start, step = run.point, run.step()
    if isinstance(step, NoStep):
        raise MobiusFlowError(f"method {options.method} has no step to measure: {step.reason}")
    rounds = [{name: _seconds(task) for name, task in _phases(start, step, options)} for _ in range(ROUNDS)]
    seconds = {name: median(each[name] for each in rounds) for name in rounds[0]}
    return Row(
        len(curve),
        "hierarchical" if hierarchical else "dense",
        {**seconds, "iteration": _iteration(run)},
        _peak(curve, options),
        _deviation(start, curve, options) if hierarchical and len(curve) <= MAX_COMPARED else None,
    )


def _started(curve: Curve, options: RelaxOptions) -> Run:
    start = Task(curve=curve).refined(options.vertices)
    return Run(start_problem(start, options), start.curve, options)


def _phases(start: Point, step: Step, options: RelaxOptions) -> Iterator[tuple[str, Callable[[], object]]]:
    """The phases of a step, ordered so that each finds what it needs; at first the point has nothing computed."""
    curve = Curve(start.placed, start.problem.mesh)
    point = start_problem(curve, options).at_curve(curve)
    objective = point.problem.objective
    yield "lists", lambda: (objective.frozen_at(point.curve), near_pairs(point.curve))  # both cache their results
    yield "energy", lambda: objective.value(point.curve)
    yield "derivative", lambda: point.derivative
    yield "metric", lambda: point.inner_product
    yield "gradient", lambda: point.gradient
    yield "retract", lambda: point.retract(point.vertices - step.size * point.gradient, point.residual)
    yield "proof", lambda: leg(point, step.legs[0].end)


def _iteration(run: Run) -> float:
    """Seconds of an iteration: the median of the means of groups, less where the method finds no more steps."""
    each: list[float] = []
    while len(each) < GROUPS * METRIC_STEPS:
        begin = time.process_time()
        step = run.step()
        if isinstance(step, NoStep):
            break
        run.accept(step)
        each.append(time.process_time() - begin)
    return median(fmean(each[k : k + METRIC_STEPS]) for k in range(0, len(each), METRIC_STEPS))


def _peak(curve: Curve, options: RelaxOptions) -> int:
    """Memory in a separate pass: while it is traced everything takes longer."""
    tracemalloc.start()
    try:
        run = _started(curve, options)
        step = run.step()
        if isinstance(step, Step):
            run.accept(step)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def _deviation(point: Point, curve: Curve, options: RelaxOptions) -> Deviation:
    exact = _started(curve, replace(options, solver="dense")).point
    space, u, v = exact.tangent_space, point.gradient, exact.gradient
    length, wanted = space.norm(u), space.norm(v)
    return Deviation(
        energy=abs(point.energy / exact.energy - 1.0),
        derivative=space.norm(space.gradient(point.derivative)[0] - v) / wanted,
        cosine=float(np.sum(u * space.apply(v))) / (length * wanted),
        norm=abs(length / wanted - 1.0),
    )


def _seconds(task: Callable[[], object]) -> float:
    begin = time.process_time()
    task()
    return time.process_time() - begin
