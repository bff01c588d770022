"""Times and errors of the compressed energy: python benchmarks/hierarchy.py [vertices ...]

One line per curve: blocks and near pairs a vertex, then the block list, the energy, and the energy with its derivative
in milliseconds of processor time; up to 10,000 vertices also the dense energy with its derivative, and the relative
error. Run it with one BLAS thread on a quiet machine.
"""

from collision import CURVES, best
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.hierarchy import BlockList, HierarchicalMoebiusEnergy
from words import words

MOST_DENSE = 10_000


def main(sizes: list[int]) -> None:
    titles = ("blocks", "near", "list", "E", "E and DE", "dense", "error")
    print(f"{'curve':18}{'vertices':>10}" + "".join(f"{title:>10}" for title in titles))
    for n in sizes:
        for name, make in CURVES.items():
            print(f"{name:18}{n:10d}" + line(Curve.from_components(make(n)), 3), flush=True)


def line(curve: Curve, repetitions: int) -> str:
    blocks = BlockList.of(curve, HierarchicalMoebiusEnergy.theta, HierarchicalMoebiusEnergy.leaf)
    energy = HierarchicalMoebiusEnergy(blocks)
    sizes = [len(blocks.first) / len(curve), len(blocks.near[0]) / len(curve)]
    times = [
        best(lambda: BlockList.of(curve, HierarchicalMoebiusEnergy.theta, HierarchicalMoebiusEnergy.leaf), repetitions),
        best(lambda: energy.value(curve), repetitions),
        best(lambda: energy.value_and_derivative(curve), repetitions),
    ]
    text = "".join(f"{number:10.2f}" for number in sizes) + "".join(f"{time:10.1f}" for time in times)
    if len(curve) > MOST_DENSE:
        return text
    exact, slow = MoebiusEnergy().value(curve), best(lambda: MoebiusEnergy().value_and_derivative(curve), 1)
    return text + f"{slow:10.1f}{abs(energy.value(curve) / exact - 1.0):10.1e}"


if __name__ == "__main__":
    main(words(__doc__, "vertices", [1_000, 10_000, 100_000], int))
