"""
Growth and packing
==================

A trefoil made of rope grows to several times its length inside a ball. Nothing is said about how it should fold: it
grows in the metric, and the repulsion of the wall and of its own strands does the rest. The rope, drawn as thick as it
is, never touches either.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import RelaxOptions, Task, minimize, read_obstacle
from mobius_flow.core.knots import knot

ball = read_obstacle("ball.obj")
task = Task(curve=knot("3_1"), obstacles=(ball,))
figure, axes = plt.subplots(1, 3, figsize=(10, 3.6), layout="constrained")
for ax, factor in zip(axes, (1.0, 2.0, 4.0), strict=True):
    result = minimize(task, RelaxOptions(grow=factor, radius=0.1, max_iterations=60, tolerance=1e-3))
    assert result.certified
    grown = result.last.grown
    assert grown > 0.75 * factor
    assert result.last.radius == (0.1,)
    draw(ax, result.curve, f"{grown:.1f} times as long", width=7)
plt.show()
