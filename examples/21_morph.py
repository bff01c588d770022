"""
A knot becomes its mirror image
===============================

Most knots are not their mirror images, but the figure eight is: `morph` finds a motion from one to the other. It begins
and ends with the very polygons that are given, and `verify` proves that it never passes through itself.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from drawing import draw
from mobius_flow.core import NoMotionError, Trajectory, morph
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify

here, there = knot("4_1"), knot("m4_1")
trajectory, path = Trajectory(), []


def record(iterate):
    trajectory.add(iterate)
    path.append(iterate.curve)


result = morph(here, there, callback=record)
print(result.message)
proof = Path(tempfile.mkdtemp(), "proof.npz")
trajectory.save(proof)
verdict = verify(proof)
print(verdict)
assert verdict.accepted
assert np.array_equal(path[0].vertices, here.vertices)
assert np.array_equal(path[-1].vertices, there.vertices)

# %%
# Both fall to the same shape, which is where the ways meet.
figure, axes = plt.subplots(2, 3, figsize=(7.5, 5), layout="constrained")
for ax, share in zip(axes.flat, (0.0, 0.1, 0.3, 0.6, 0.9, 1.0), strict=True):
    number = round(share * (len(path) - 1))
    draw(ax, path[number], f"iterate {number}")
plt.show()

# %%
# For the trefoil there is no such motion, and the signature says so before anything moves.
refused = ""
try:
    morph(knot("3_1"), knot("m3_1"))
except NoMotionError as error:
    refused = str(error)
print(refused)
assert "signatures" in refused
