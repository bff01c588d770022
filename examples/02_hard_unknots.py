"""
Hard unknots
============

Each of these diagrams has to become more complicated before Reidemeister moves can simplify it. The Möbius energy
knows nothing of diagrams, and gradient descent leads all of them to the circle.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import minimize
from mobius_flow.core.knots import knot

NAMES = ("culprit", "goeritz", "thistlethwaite", "ochiai-1")

figure, axes = plt.subplots(2, len(NAMES), figsize=(10, 5), layout="constrained")
for name, above, below in zip(NAMES, *axes, strict=True):
    curve = knot(name)
    result = minimize(curve)
    assert result.certified
    assert abs(result.final_energy - 4.0) < 1e-2
    draw(above, curve, name, width=2.5)
    draw(below, result.curve, f"{result.iterations} iterations", width=2.5)
plt.show()
