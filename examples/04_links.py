"""
Links
=====

A curve may have any number of components, none of which passes through another. The Borromean rings are linked although
no two of them are.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import minimize
from mobius_flow.core.knots import knot, knot_type

NAMES = ("L2a1", "L4a1", "L5a1", "L6a4")

figure, axes = plt.subplots(1, len(NAMES), figsize=(11, 3), layout="constrained")
for ax, name in zip(axes, NAMES, strict=True):
    result = minimize(knot(name))
    assert result.certified
    assert name in str(knot_type(result.curve))
    draw(ax, result.curve, f"{name}: {result.final_energy:.1f}", width=3.5)
plt.show()
