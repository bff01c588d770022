"""
An obstacle
===========

A loop that is threaded through a square frame. Left alone it would become a round circle about its own barycenter; the
frame is an obstacle which the loop neither touches nor leaves.
"""

import matplotlib.pyplot as plt
import numpy as np
from drawing import draw
from mobius_flow.core import Curve, Obstacle, Task, minimize

t = np.linspace(0, 2 * np.pi, 48, endpoint=False)
loop = Curve(np.stack([1.5 + 1.5 * np.cos(t), 0.25 * np.sin(5 * t), np.sin(t) + 0.2 * np.sin(4 * t)], axis=1))
corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * 1.2
frame = Obstacle(corners, [[0, 1], [1, 2], [2, 3], [3, 0]], "frame")

alone = minimize(loop)
result = minimize(Task(curve=loop, obstacles=(frame,)))
assert result.certified
assert alone.final_energy < result.final_energy

axes_of_view = np.array([[0.8, 0.5, 0.33], [-0.6, 0.7, 0.4], [0.0, -0.5, 0.85]]).T
axes_of_view = np.linalg.qr(axes_of_view)[0]
figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for ax, curve, title in zip(axes, (loop, result.curve), ("start", f"$E$ = {result.final_energy:.2f}"), strict=True):
    link = Curve.from_components([curve.vertices, np.concatenate([np.linspace(a, b, 24, endpoint=False) for a, b in
                                  zip(corners, np.roll(corners, -1, axis=0), strict=True)])])  # fmt: skip
    draw(ax, link, title, frame=axes_of_view, width=3.5)
plt.show()
