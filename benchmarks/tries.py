"""What single tries lead to from local minima: the first table about hops in docs/local-minima.md.

    python benchmarks/tries.py                   every minimum, 6 seeds
    python benchmarks/tries.py T38 --seeds 2     one of them

A row tells where the run without hops ends; how many pushes and how many stirs, one for each seed, lead lower by what
counts for a hop; and where it ends again after 250 steps down the tangent-point energy.
"""

import argparse
from dataclasses import replace

import numpy as np
from hops import CASES
from mobius_flow.core import Curve, RelaxOptions, minimize
from mobius_flow.core.driver.hopping import Hops, trial
from mobius_flow.core.driver.motions import MOTIONS, Motion
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run

MINIMA = ("T35", "T38", "T3-10", "T65")
STEPS = 250  # down the other energy


def leads_lower(curve: Curve, options: RelaxOptions, motion: Motion, seed: int) -> bool:
    """Whether one motion from a curve at rest, followed by a relaxation, ends lower; not if numbers fail on the way."""
    run = Run(start_problem(curve, options), curve, options)
    below = (1.0 - Hops.gain) * run.iterate.energy
    try:
        return trial(run, motion, np.random.default_rng(seed), below).run.iterate.energy < below
    except np.linalg.LinAlgError:
        return False


def by_another_energy(curve: Curve, options: RelaxOptions) -> float:
    """The energy after some steps down another one, and all the way back."""
    other = minimize(curve, replace(options, energy="tangent-point", max_iterations=STEPS))
    return minimize(other.curve, options).final_energy


def row(name: str, seeds: int) -> str:
    """The result of one case."""
    make, options = CASES[name]
    rested = minimize(make(), options)
    curve = rested.curve
    options = RelaxOptions(mesh="fixed", vertices=len(curve), edge_lengths="keep", max_iterations=4000)
    lower = [sum(leads_lower(curve, options, motion, seed) for seed in range(seeds)) for motion in MOTIONS]
    counts = " | ".join(f"{count} of {seeds}" for count in lower)
    return f"| {name} | {rested.final_energy:.2f} | {counts} | {by_another_energy(curve, options):.2f} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=f"cases of hops.py; by default {', '.join(MINIMA)}")
    parser.add_argument("--seeds", type=int, default=6, metavar="K", help="tries by each motion (default: 6)")
    arguments = parser.parse_args()
    print("| from | energy | pushes that led lower | stirs that did | by the tangent-point energy |")
    print("| --- | --- | --- | --- | --- |")
    for name in arguments.names or MINIMA:
        print(row(name, arguments.seeds), flush=True)


if __name__ == "__main__":
    main()
