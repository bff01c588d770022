"""
A motion to turn and to play
============================

`mobius-flow view path.npz motion.html` makes a page of a trajectory that needs no network: tubes, a slider through the
motion, and the energy of every frame. The same page comes from Python, here within this one.
"""

import html
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import Trajectory, minimize
from mobius_flow.core.keys.view import motion, page
from mobius_flow.core.knots import knot

trajectory = Trajectory()
minimize(knot("thistlethwaite"), callback=trajectory.add)
path = Path(tempfile.mkdtemp(), "path.npz")
trajectory.save(path)
shown = motion(path, frames=40)
assert shown.energies[-1] < 4.01  # the circle's, as it is an unknot


class Framed:
    """A page within a page."""

    def _repr_html_(self):
        return f'<iframe srcdoc="{html.escape(page(shown))}" style="border: 0; width: 100%; height: 500px"></iframe>'


Framed()

# %%
# Some of its frames, as knots are drawn on paper:
figure, axes = plt.subplots(1, 4, figsize=(8, 2.2), layout="constrained")
for ax, number in zip(axes, (0, 8, 16, len(shown.curves) - 1), strict=True):
    draw(ax, shown.curves[number], f"frame {number}")
plt.show()
