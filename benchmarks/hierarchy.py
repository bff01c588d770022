"""Times and errors of the compressed energy: python benchmarks/hierarchy.py [vertices ...]

One line per curve: blocks and near pairs a vertex, then the block list, the energy, and the energy with its derivative
in milliseconds of processor time; up to 10,000 vertices also the dense energy with its derivative, and the relative
error. Run it with one BLAS thread on a quiet machine.
"""

import sys
from collections.abc import Callable
from time import process_time

from collision import CURVES
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.hierarchy import HierarchicalMoebiusEnergy
from mobius_flow.core.hierarchy.energy import block_list

MOST_DENSE = 10_000


def milliseconds(work: Callable[[], object], repeats: int = 3) -> float:
    times = []
    for _ in range(repeats):
        start = process_time()
        work()
        times.append(process_time() - start)
    return 1e3 * min(times)


def fresh_list(curve: Curve) -> None:
    block_list.cache_clear()
    block_list(curve)


def report(name: str, curve: Curve) -> None:
    n, made = len(curve), milliseconds(lambda: fresh_list(curve))
    blocks, energy = block_list(curve), HierarchicalMoebiusEnergy().frozen_at(curve)
    value = milliseconds(lambda: energy.value(curve))
    both = milliseconds(lambda: energy.value_and_derivative(curve))
    print(
        f"{name:18} {n:7} {len(blocks.first) / n:7.2f} {len(blocks.i) / n:7.1f} {made:8.1f} {value:8.1f} {both:8.1f}",
        end="",
    )
    if n <= MOST_DENSE:
        dense = MoebiusEnergy()
        slow = milliseconds(lambda: dense.value_and_derivative(curve), repeats=1)
        exact = dense.value(curve)
        print(f" {slow:8.1f} {abs(energy.value(curve) - exact) / exact:9.1e}", end="")
    print(flush=True)


if __name__ == "__main__":
    print(
        f"{'curve':18} {'n':>7} {'blocks':>7} {'near':>7} {'list':>8} {'E':>8} {'E, DE':>8} {'dense':>8} {'error':>9}"
    )
    for count in [int(argument) for argument in sys.argv[1:]] or [1_000, 10_000, 100_000]:
        for name, components in CURVES.items():
            report(name, Curve.from_components(components(count)))
