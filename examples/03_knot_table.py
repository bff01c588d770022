"""
Knots of the table
==================

Prime knots with up to seven crossings, relaxed from braid closures, with their Möbius energies. Among them the energy
grows with the crossing number, but orders the knots within a crossing number in its own way.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import knot

NAMES = ("0_1", "3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3", "7_1", "7_4")

results = {name: minimize(knot(name), RelaxOptions(tolerance=1e-3)) for name in NAMES}

figure, axes = plt.subplots(2, 5, figsize=(11, 4.8), layout="constrained")
for ax, (name, result) in zip(axes.flat, results.items(), strict=True):
    assert result.certified
    draw(ax, result.curve, f"${name}$: {result.final_energy:.1f}", width=3.5)

energies = [result.final_energy for result in results.values()]
assert energies == sorted(energies)
plt.show()
