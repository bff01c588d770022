"""
A wire to print
===============

A tube as wide as a relaxed curve has room for; a wider one would run into itself, and is refused.
"""

import matplotlib.pyplot as plt
from mobius_flow.core import CurveError, minimize
from mobius_flow.core.collision.gap import thickness
from mobius_flow.core.keys.solids import solid, wire
from mobius_flow.core.knots import knot

curve = minimize(knot("5_1", 150)).curve
widest = 2 * thickness(curve)
tube = wire(curve, 0.9 * widest)[0]
print(f"{len(tube.faces)} triangles, {len(solid(curve, 'stl', 0.9 * widest)) // 1000} kB")

refused = ""
try:
    wire(curve, 1.5 * widest)
except CurveError as error:
    refused = str(error)
print(refused)
assert "room for" in refused

# %%
ax = plt.figure(figsize=(5, 4)).add_subplot(projection="3d")
ax.plot_trisurf(*tube.points.T, triangles=tube.faces, color="#3b6fb6", linewidth=0)
ax.set_aspect("equal")
ax.axis("off")
ax.view_init(60, -90)
plt.show()
