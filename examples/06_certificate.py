"""
A certificate, and a forged one
===============================

A trajectory file holds the path of a run as piecewise linear motions of the vertices. `verify` shares no code with
the solver and decides, in exact arithmetic where it must, whether any two strands meet on the way.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from mobius_flow.core import Trajectory, relax
from mobius_flow.core.collision import minimal_gap
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify

curve = knot("goeritz")
trajectory, path = Trajectory(), []
for iterate in relax(curve):
    trajectory.add(iterate)
    path.append(iterate.curve)

folder = Path(tempfile.mkdtemp())
trajectory.save(folder / "path.npz")
verdict = verify(folder / "path.npz")
print(verdict)
assert verdict.accepted

# %%
# A forgery: the start is pressed through a plane, onto its mirror image.
arrays = {name: array for name, array in np.load(folder / "path.npz").items() if name.endswith("_000")}
start = arrays["stage_000"][0]
arrays["stage_000"] = np.stack([start, start * [1, 1, -1]])
np.savez(folder / "forged.npz", **arrays)
forged = verify(folder / "forged.npz")
print(forged)
assert not forged.accepted

# %%
# Along the certified path strands keep their distance; along the forged one it drops to zero.
pressed = [path[0].with_vertices(start * [1, 1, 1 - 2 * t]) for t in np.linspace(0, 1, len(path))]
figure, ax = plt.subplots(figsize=(6, 3.5), layout="constrained")
for label, curves in (("certified", path), ("forged", pressed)):
    ax.plot([minimal_gap(each)[0] / each.length for each in curves], label=label)
ax.set(xlabel="frame", ylabel="least distance of strands / length", ylim=(0, None))
ax.legend()
plt.show()
