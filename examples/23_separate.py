"""
Cables that keep clear
======================

Straight strands between two plates run through each other. `separate` makes ropes of them, moved as little as their
radii allow; the ends stay in place, and what crossed at first is told.
"""

import matplotlib.pyplot as plt
import numpy as np
from drawing import draw
from mobius_flow.core import Curve, separate

rng = np.random.default_rng(1)
grid = np.array([(x + 0.5 * (y % 2), 0.87 * y) for x in range(4) for y in range(4)]) * 3.0
t = np.linspace(0.0, 1.0, 31)[:, None]
pairs = zip(grid, grid[rng.permutation(len(grid))], strict=True)
strands = [np.hstack([(1 - t) * here + t * there, 24 * t]) for here, there in pairs]
bundle = Curve.from_components(strands, [False] * len(strands))

path = []
result = separate(bundle, 1.0, callback=lambda iterate: path.append(iterate.curve))
print(result.message)
assert result.outcome.converged
assert (result.curve.vertices[bundle.mesh.ends] == bundle.vertices[bundle.mesh.ends]).all()

# %%
# Any two points of different cables are two radii apart or more: here at the vertices, and proved in between.
own = bundle.mesh.component
apart = np.linalg.norm(result.curve.vertices[:, None] - result.curve.vertices, axis=2)[own[:, None] != own]
print(f"nearest vertices {apart.min():.2f} apart, lengths grown by {result.curve.length / bundle.length - 1:.1%}")
assert apart.min() >= 2.0

# %%
# The motion, from the side.
side = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
figure, axes = plt.subplots(1, 3, figsize=(8, 5), layout="constrained")
for ax, share in zip(axes, (0.0, 0.6, 1.0), strict=True):
    number = round(share * (len(path) - 1))
    draw(ax, path[number], f"iterate {number}", frame=side.T[:, [1, 0, 2]], width=8.0)
plt.show()
