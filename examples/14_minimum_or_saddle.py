"""
Minimum or saddle
=================

A torus knot wound as T(3, 4) comes to rest where the gradient vanishes and the second derivative has negative
eigenvalues: at a saddle, kept there by its symmetry. ``escape_saddles`` follows such a direction downhill.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import torus_knot

curve = torus_knot(3, 4, 120)
settings = {"method": "trust-region", "vertices": 120}
saddle = minimize(curve, RelaxOptions(stability=True, **settings))
minimum = minimize(curve, RelaxOptions(escape_saddles=True, **settings))
assert saddle.outcome.negative_eigenvalues > 0
assert minimum.outcome.negative_eigenvalues == 0
assert minimum.final_energy < saddle.final_energy

figure, axes = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for ax, result in zip(axes, (saddle, minimum), strict=True):
    assert result.certified
    index = result.outcome.negative_eigenvalues
    draw(ax, result.curve, f"index {index}: $E$ = {result.final_energy:.2f}")
plt.show()
