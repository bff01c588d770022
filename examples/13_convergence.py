"""
How the energies converge
=========================

The energy of polygons inscribed in a smooth curve, here a torus knot, approaches that of the curve. The midpoint rule's
error is of second order in the edge length, so that Richardson's extrapolation applies; with more Gauss points on the
edges it is of first order.
"""

import matplotlib.pyplot as plt
import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.energies import ENERGIES


def trefoil(n):
    """A polygon inscribed in a torus knot."""
    t = 2 * np.pi * np.arange(n) / n
    radius = 2 + np.cos(3 * t)
    return Curve(np.stack([radius * np.cos(2 * t), radius * np.sin(2 * t), np.sin(3 * t)], axis=1))


counts = np.array([100, 200, 400, 800])
energies = {
    name: np.array([ENERGIES[name].value(trefoil(n)) for n in counts])
    for name in ("moebius", "moebius-k2", "moebius-k3")
}
coarse, fine = energies["moebius"][-2:]
exact = fine + (fine - coarse) / 3

figure, ax = plt.subplots(figsize=(6, 4), layout="constrained")
orders = {}
for name, values in energies.items():
    errors = abs(values - exact)
    orders[name] = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    ax.loglog(counts, errors, "o-", label=f"{name}, order {orders[name]:.2f}")
assert abs(orders["moebius"] - 2) < 0.1
assert abs(orders["moebius-k2"] - 1) < 0.1
ax.set(xlabel="vertices", ylabel="error")
ax.legend()
plt.show()
