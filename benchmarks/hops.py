"""What hops lead to from local minima, and from where curves are stuck: the table in docs/local-minima.md.

    python benchmarks/hops.py                    every case, 6 hops each
    python benchmarks/hops.py T35 --hops 2       one of them

Processor time is limited, for each run by itself; one that is cut short ends with its lowest curve.

A row tells where a run ends without hops and with how many vertices; if it is at rest, the index there (0: a minimum),
and with every edge halved its energy and, in brackets, its index; then where it ends with hops, whether the verifier
accepts the whole way, and the processor time of both runs.
"""

import argparse
import signal
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from hard_curves import lattice_unknot
from mobius_flow.core import Curve, RelaxOptions, Result, Status, Trajectory, minimize
from mobius_flow.core.curve.refine import subdivide
from mobius_flow.core.knots import knot, scramble, smooth_knot, torus_knot
from mobius_flow.core.proof import verify

PATIENT = RelaxOptions(max_iterations=1_000_000)  # a try may take as many as a run: time is the limit
ESCAPING = replace(PATIENT, escape_saddles=True)
CASES: Mapping[str, tuple[Callable[[], Curve], RelaxOptions]] = {
    "T34": (partial(torus_knot, 3, 4), PATIENT),
    "T35": (partial(torus_knot, 3, 5), ESCAPING),
    "T38": (partial(torus_knot, 3, 8), ESCAPING),
    "T3-10": (partial(torus_knot, 3, 10), ESCAPING),
    "T45": (partial(torus_knot, 4, 5), PATIENT),
    "T65": (partial(torus_knot, 6, 5), ESCAPING),
    "4_1-scrambled": (lambda: scramble(smooth_knot("4_1", 120), seed=1), PATIENT),
    "unknot-60-3": (partial(lattice_unknot, 60, 3), PATIENT),
    "unknot-60-4": (partial(lattice_unknot, 60, 4), PATIENT),
    "haken": (partial(knot, "haken"), replace(PATIENT, mesh="fixed")),
}


def limited(minutes: float, curve: Curve, options: RelaxOptions, trajectory: Trajectory | None = None) -> Result:
    """The end of a run, or the lowest curve when its processor time is up, even in the middle of a hop."""
    signal.signal(signal.SIGPROF, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_PROF, 60.0 * minutes)
    try:
        return minimize(curve, options, trajectory.add if trajectory else None)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def at_rest(minutes: float, curve: Curve) -> tuple[str, float]:
    """Index and energy of the curve relaxed further on its own mesh; of 2,500 vertices matrices would take 2 GB."""
    options = RelaxOptions(mesh="fixed", vertices=len(curve), edge_lengths="keep", stability=len(curve) <= 2500)
    result = limited(minutes, curve, options)
    count = result.outcome.negative_eigenvalues
    return "–" if count is None else str(count), result.final_energy


def row(name: str, hops: int, minutes: float) -> str:
    """The result of one case."""
    make, options = CASES[name]
    began = time.process_time()
    plain = limited(minutes, make(), options)
    trajectory = Trajectory()
    result = limited(minutes, make(), replace(options, hops=hops), trajectory)
    seconds = time.process_time() - began
    with TemporaryDirectory() as directory:
        trajectory.save(Path(directory) / "T.npz")
        verified = result.certified and verify(Path(directory) / "T.npz").accepted
    rest = f"{'stuck' if plain.status is Status.STALLED else 'cut short'} | –"
    if plain.status is Status.CONVERGED:
        index, energy = at_rest(minutes, subdivide(plain.curve, np.full(len(plain.curve), 2)))
        rest = f"{at_rest(minutes, plain.curve)[0]} | {energy:.2f} ({index})"
    ends = f"{len(plain.curve)} | {plain.final_energy:.2f} | {rest} | {result.final_energy:.2f}"
    return f"| {name} | {ends} | {'yes' if verified else 'NO'} | {seconds:.0f} s |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=f"cases: {', '.join(CASES)}")
    parser.add_argument("--hops", type=int, default=6, metavar="K", help="hops tried (default: 6)")
    parser.add_argument("--minutes", type=float, default=10.0, help="processor time of a run, at most (default: 10)")
    arguments = parser.parse_args()
    print("| case | vertices | energy | index | edges halved | with hops | verified | time |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name in arguments.names or CASES:
        print(row(name, arguments.hops, arguments.minutes), flush=True)


if __name__ == "__main__":
    main()
