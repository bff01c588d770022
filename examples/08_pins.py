"""
Pins
====

Pinned vertices keep their coordinates to the last digit; ``pin_tangents`` keeps the directions there as well. Between
pinned ends the overhand knot tightens until the energy balances its bends.
"""

import matplotlib.pyplot as plt
import numpy as np
from drawing import draw, view
from mobius_flow.core import RelaxOptions, Task, minimize
from mobius_flow.core.knots import overhand

curve = overhand()
ends = (0, len(curve) - 1)
result = minimize(Task(curve=curve, pins=ends, pin_tangents=True), RelaxOptions(tolerance=1e-3))
assert result.certified
assert np.array_equal(result.curve.vertices[[0, -1]], curve.vertices[list(ends)])

figure, axes = plt.subplots(1, 2, figsize=(9, 3.2), layout="constrained")
frame = view(curve)
for ax, shown, title in zip(axes, (curve, result.curve), ("start", "relaxed"), strict=True):
    draw(ax, shown, title, frame=frame, width=3)
    marks = (shown.vertices[[0, -1]] - shown.vertices.mean(axis=0)) @ frame
    ax.plot(*marks[:, :2].T, "D", color="#d9a441", markersize=7, zorder=3)
plt.show()
