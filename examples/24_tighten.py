"""
A trefoil pulled tight
======================

The shortest rope of given thickness that is knotted: `tighten` finds it, and the forces at its contacts.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from drawing import draw
from mobius_flow.core import Trajectory, tighten
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify

trajectory, path = Trajectory(), []


def record(iterate):
    trajectory.add(iterate)
    path.append(iterate)


result = tighten(knot("3_1"), vertices=200, callback=record)
print(result.message)
assert result.outcome.ropelength < 32.78
proof = Path(tempfile.mkdtemp(), "proof.npz")
trajectory.save(proof)
verdict = verify(proof)
print(verdict)
assert verdict.accepted

figure, axes = plt.subplots(1, 3, figsize=(7.5, 2.7), layout="constrained")
for ax, number in zip(axes, (0, len(path) // 3, -1), strict=True):
    draw(ax, path[number].curve, f"ropelength {path[number].energy:.1f}")
plt.show()

# %%
# Where strands press on each other, by their places along the rope: forces are shares of the tension.
edge, other, force = np.array(result.outcome.struts).T
figure, ax = plt.subplots(figsize=(4, 4), layout="constrained")
ax.scatter(np.append(edge, other), np.append(other, edge), 40.0 * np.append(force, force))
ax.set(aspect="equal", xlabel="edge", ylabel="edge")
plt.show()
