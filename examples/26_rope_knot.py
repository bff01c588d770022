"""
A knot pulled tight by its ends
===============================

`tighten` pulls open ropes by their ends, as long as they slide. A film of it, which looks at the knot:
"""

import matplotlib.pyplot as plt
import numpy as np
from drawing import view
from matplotlib.animation import FuncAnimation
from matplotlib.collections import LineCollection
from mobius_flow.core import Curve, tighten
from mobius_flow.core.keys.placement import framed
from mobius_flow.core.knots import knot
from scipy.ndimage import uniform_filter1d

path = []
result = tighten(knot("open-figure-eight"), vertices=200, callback=path.append)
print(result.message)
assert result.certified
assert result.outcome.converged

# right, up and near, from where the tight knot is seen best; the camera comes nearer as the knot gets smaller
axes = view(Curve(framed(path[-1].curve), path[-1].curve.mesh))
shapes = [(each.curve.vertices - each.curve.vertices.mean(axis=0)) @ axes for each in path]
widths = [1.2 * np.ptp(framed(each.curve) @ axes[:, 0]) for each in path]
widths = uniform_filter1d(np.maximum.accumulate(widths[::-1])[::-1], 15, mode="nearest")
# moments between which the camera comes evenly nearer
way = np.append(0.0, np.cumsum(1e-3 - np.diff(np.log(widths))))
moments = np.searchsorted(way, np.linspace(0.0, way[-1], 40)).clip(max=len(path) - 1)
figure, ax = plt.subplots(figsize=(6, 3), dpi=72, layout="constrained")


def show(moment: int) -> None:
    """Draw the rope as thick as it is, with a dark edge, what is near over what is far."""
    mesh, wide = path[moment].curve.mesh, widths[moment]
    ends = np.stack([shapes[moment][mesh.tails], shapes[moment][mesh.heads]], axis=1)
    order = np.repeat(np.argsort(ends[:, :, 2].sum(axis=1)), 2)
    points = 6.0 * 72.0 * 2.0 * result.last.radius[0] / wide
    colors = plt.cm.copper(0.45 + 0.45 * np.linspace(0.0, 1.0, len(order)))
    colors[::2] = 0.1, 0.05, 0.0, 1.0
    ax.clear()
    thick = [points, points - 2.5] * len(ends)
    ax.add_collection(LineCollection(ends[order, :, :2], colors=colors, linewidths=thick, capstyle="round"))
    ax.set(xlim=(-0.5 * wide, 0.5 * wide), ylim=(-0.25 * wide, 0.25 * wide), aspect="equal")
    ax.set_axis_off()


film = FuncAnimation(figure, show, moments, interval=80)
plt.show()
