"""
Open arcs
=========

An arc can always be unknotted: an end slips through. O'Hara's energy vanishes on straight segments and on nothing
else, so that is where an overhand knot ends.
"""

import matplotlib.pyplot as plt
from drawing import draw, view
from mobius_flow.core import relax
from mobius_flow.core.knots import overhand

curve = overhand()
iterates = list(relax(curve))
last = iterates[-1]
assert last.certified
assert last.energy < 1e-2

stages = [iterates[len(iterates) * k // 6] for k in range(5)] + [last]
figure, axes = plt.subplots(2, 3, figsize=(9, 5), layout="constrained")
for ax, stage in zip(axes.flat, stages, strict=True):
    draw(ax, stage.curve, f"$E$ = {stage.energy:.2f}", frame=view(curve), width=3)
plt.show()
