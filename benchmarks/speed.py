"""What a step costs, size by size: the figures in docs/performance.md.

    export OPENBLAS_NUM_THREADS=1
    python benchmarks/speed.py
    python benchmarks/speed.py --sizes 200,592,1000,2000,5000 --solver dense --json > dense.json
    python benchmarks/speed.py --sizes 200,1000,5000,20000 --solver hierarchical --json > hierarchical.json
    python benchmarks/speed.py --draw docs/pictures/speed.png dense.json hierarchical.json

Steps are taken on a bent trefoil. Printed are milliseconds of processor time, all threads together, so that other
programs count for little: "lists" of near pairs and of pairs of clusters; "energy"; "derivative", which includes the
energy; "metric", building J; "gradient", factorising or preconditioning the saddle-point system and solving it;
"retract", the way back to the constraints; "proof", collision detection along the step; and "iteration", all that a
step takes on average. What remains of the machine is its speed, represented by the times of two plain operations.

Up to 3,000 vertices follows how far the hierarchical solver is from the dense one: relative errors of the objective;
of the projected gradient, in the norm of the dense J, that comes from its derivative alone, which may move minimisers;
and of the projected gradient's norm in the dense J. This and the angle between both gradients, in the dense J, arise
mostly because the compressed J is another inner product, which changes nothing but the path.
"""

import argparse
import json
import sys
import time
import tracemalloc
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import fmean, median
from typing import Any

import numpy as np
from hard_curves import bent_trefoil
from mobius_flow.cli import options as relax_options
from mobius_flow.core import METHODS, Curve, MobiusFlowError, RelaxOptions, Task
from mobius_flow.core.base.threads import BLAS
from mobius_flow.core.descent import NoStep
from mobius_flow.core.descent.step import leg
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.energies.barrier import near_pairs
from mobius_flow.core.energies.hierarchy import HierarchicalMoebiusEnergy

ASYMPTOTIC = 2000  # vertices from which times are expected to follow a power law
Row = dict[str, Any]


def seconds_of(task: Callable[[], object]) -> float:
    """Processor time of a task."""
    begin = time.process_time()
    task()
    return time.process_time() - begin


def machine() -> dict[str, float]:
    """Seconds, medians of five, for a product of 1000 × 1000 matrices (dgemm), and for a copy of 100 MB in memory."""
    matrix, source = np.random.default_rng(1).normal(size=(1000, 1000)), np.ones(12_500_000)
    product, target = np.empty_like(matrix), source.copy()
    tasks = {
        "product": lambda: np.matmul(matrix, matrix, out=product),
        "copy": lambda: np.copyto(target, source),
    }
    return {name: median(seconds_of(task) for _ in range(5)) for name, task in tasks.items()}


def started(curve: Curve, options: RelaxOptions) -> Run:
    start = Task(curve=curve).refined(options.vertices)
    return Run(start_problem(start, options), start.curve, options)


@BLAS.bounded()
def measured(size: int, options: RelaxOptions) -> Row:
    """The figures of one size, with options whose mesh is fixed."""
    curve, options = bent_trefoil(size), replace(options, vertices=size)
    run = started(curve, options)
    start, step = run.point, run.step()
    if isinstance(step, NoStep):
        raise MobiusFlowError(f"method {options.method} has no step to measure: {step.reason}")
    rounds = []
    for _ in range(5):
        shape = Curve(start.placed, start.problem.mesh)
        point = start_problem(shape, options).at_curve(shape)  # at first it has nothing computed
        objective = point.problem.objective
        phases = {  # ordered so that each finds what it needs
            "lists": lambda: (objective.frozen_at(point.curve), near_pairs(point.curve)),  # noqa: B023 (called at once)
            "energy": lambda: objective.value(point.curve),  # noqa: B023
            "derivative": lambda: point.derivative,  # noqa: B023
            "metric": lambda: point.inner_product,  # noqa: B023
            "gradient": lambda: point.gradient,  # noqa: B023
            "retract": lambda: point.retract(point.vertices - step.size * point.gradient, point.residual),  # noqa: B023
            "proof": lambda: leg(point, step.legs[0].end),  # noqa: B023
        }
        rounds.append({name: seconds_of(task) for name, task in phases.items()})
    seconds = {name: median(each[name] for each in rounds) for name in rounds[0]}
    # an iteration: the median of the means of three groups, as long as methods may keep their metric
    each: list[float] = []
    group = METHODS["lbfgs"].rule.metric_steps
    while len(each) < 3 * group:
        begin = time.process_time()
        step = run.step()
        if isinstance(step, NoStep):
            break
        run.accept(step)
        each.append(time.process_time() - begin)
    seconds["iteration"] = median(fmean(each[k : k + group]) for k in range(0, len(each), group))
    # memory in a separate pass, to the end of the first iteration: while it is traced everything takes longer
    tracemalloc.start()
    traced = started(curve, options)
    traced.accept(traced.step())
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    hierarchical, deviation = isinstance(run.problem.objective.energy, HierarchicalMoebiusEnergy), None
    if hierarchical and size <= 3000:
        exact = started(curve, replace(options, solver="dense")).point
        space, u, v = exact.tangent_space, start.gradient, exact.gradient
        length, wanted = space.norm(u), space.norm(v)
        deviation = {
            "energy": abs(start.energy / exact.energy - 1.0),
            "derivative": space.norm(space.gradient(start.derivative)[0] - v) / wanted,
            "cosine": float(np.sum(u * space.apply(v))) / (length * wanted),
            "norm": abs(length / wanted - 1.0),
        }
    solver = "hierarchical" if hierarchical else "dense"
    return {"vertices": size, "solver": solver, "seconds": seconds, "peak_bytes": peak, "deviation": deviation}


def exponents(rows: Sequence[Row]) -> dict[str, float]:
    """For each solver the p of seconds ~ Nᵖ for whole iterations, by least squares in the logarithms.

    From N = 2000 on; solvers with fewer than two such sizes are left out.
    """
    fits = {}
    for solver in sorted({row["solver"] for row in rows}):
        own = [row for row in rows if row["vertices"] >= ASYMPTOTIC and row["solver"] == solver]
        if len(own) > 1:
            x, y = np.log([(row["vertices"], row["seconds"]["iteration"]) for row in own]).T
            fits[solver] = float(np.polyfit(x, y, 1)[0])
    return fits


def tell(speed: Mapping[str, float], rows: Iterable[Row]) -> None:
    """Print the rows as they come, then the conclusions from all of them."""

    def line(row: Row, unit: float) -> str:
        times = "".join(f" {x / unit:10.3f}" for x in row["seconds"].values())
        return f"{row['vertices']:8d} {row['solver']:12}{times}"

    done: list[Row] = []
    for row in rows:
        head = f"{'vertices':>8} {'solver':12}" + "".join(f" {name:>10}" for name in row["seconds"])
        if not done:
            print(f"milliseconds of processor time, and the most memory\n{head}       MB")
        done.append(row)
        print(f"{line(row, 1e-3)} {row['peak_bytes'] / 1e6:8.1f}", flush=True)
    for name, what in (("product", "products of 1000 × 1000 matrices"), ("copy", "copies of 100 MB")):
        print(f"\nthe same in {what}, of {1e3 * speed[name]:.1f} ms each\n{head}")
        print("\n".join(line(row, speed[name]) for row in done))
    for solver, exponent in exponents(done).items():
        print(f"\n{solver} iterations take time like N^{exponent:.2f} from {ASYMPTOTIC} vertices on")
    for row in done:
        if off := row["deviation"]:
            errors = ", ".join(f"{name} {off[name]:.1e}" for name in ("energy", "derivative", "norm"))
            print(f"{row['vertices']} vertices, against dense: {errors}, cosine {off['cosine']:.6f}")


def draw(target: Path, rows: Sequence[Row]) -> None:
    """Draw iterations and memory above, the phases of both solvers below."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 7.5), layout="constrained")
    (times, memory), below = figure.subplots(2, 2, sharex=True)
    times.set(title="one iteration", ylabel="seconds of processor time")
    memory.set(title="memory", ylabel="MB")
    for axes, (solver, colour) in zip(below, (("dense", "C3"), ("hierarchical", "C0")), strict=True):
        own = sorted((row for row in rows if row["solver"] == solver), key=lambda row: int(row["vertices"]))
        sizes = [row["vertices"] for row in own]
        style = {"label": solver, "color": colour, "marker": "o"}
        times.plot(sizes, [row["seconds"]["iteration"] for row in own], **style)
        memory.plot(sizes, [row["peak_bytes"] / 1e6 for row in own], **style)
        # the energy by itself and lists are parts of others
        for number, name in enumerate(("derivative", "metric", "gradient", "retract", "proof")):
            axes.plot(sizes, [row["seconds"][name] for row in own], label=name, color=f"C{number}", marker=".")
        axes.set(title=f"phases of a step, {solver}", xlabel="vertices", ylabel="seconds of processor time")
    below[1].sharey(below[0])
    for axes in (times, memory, *below):
        axes.set(xscale="log", yscale="log")
        axes.grid(alpha=0.3)
        axes.legend()
    figure.savefig(target, dpi=110)


def main() -> int:
    """Measure the machine and every size, and print tables, or JSON at the end; or draw what was measured."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    default = "200,592,1000,2000,5000,10000"
    parser.add_argument("--sizes", default=default, metavar="N,N,…", help=f"numbers of vertices (default: {default})")
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    parser.add_argument("--draw", type=Path, metavar="OUT.png", help="draw the figures of JSON files")
    parser.add_argument("figures", nargs="*", type=Path, metavar="IN.json")
    relax_options.add_to(parser)
    given = parser.parse_args()
    if given.draw:
        figures = (json.loads(path.read_text(encoding="utf-8")) for path in given.figures)
        draw(given.draw, [row for each in figures for row in each["rows"]])
        return 0
    sizes = [int(word) for word in given.sizes.split(",")]
    if min(sizes) < 60:
        parser.error("the bent knot is still a trefoil with 60 vertices or more")
    try:
        wanted, speed = replace(relax_options.from_arguments(given), mesh="fixed"), machine()
        rows = (measured(size, wanted) for size in sizes)
        if not given.json:
            tell(speed, rows)
            return 0
        done = list(rows)
        units = {"in_products": speed["product"], "in_copies": speed["copy"]}
        for row in done:
            row |= {name: {k: x / unit for k, x in row["seconds"].items()} for name, unit in units.items()}
        report = {"machine": speed, "rows": done, "exponents": exponents(done), "options": vars(wanted)}
        print(json.dumps(report | relax_options.environment(), indent=1))
    except MobiusFlowError as error:
        parser.error(str(error))
    return 0


if __name__ == "__main__":
    sys.exit(main())
