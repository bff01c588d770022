"""
Balanced shapes
===============

Möbius transformations change the shape of a knot but not its energy, so a knot may come to rest with most of its length
in one large loop. ``balance`` moves on to the image that bends least, :math:`\\int\\kappa^2\\,ds\\cdot L`.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import knot

curve = knot("6_3")
plain = minimize(curve, RelaxOptions(vertices=200))
balanced = minimize(curve, RelaxOptions(vertices=200, balance=True))
assert balanced.certified
assert abs(balanced.final_energy - plain.final_energy) < 0.01 * plain.final_energy

figure, axes = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for ax, result, title in zip(axes, (plain, balanced), ("relaxed", "balanced"), strict=True):
    draw(ax, result.curve, f"{title}: $E$ = {result.final_energy:.1f}")
plt.show()
