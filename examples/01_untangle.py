"""
Untangle an unknot
==================

``tangle.obj`` is an unknot with twenty crossings. Descending on its Möbius energy leads to the round circle, whose
energy is 4; every step on the way is proved free of contact. On a fixed mesh there are steps of the descent only, and
all energies are of polygons with the same vertices.
"""

from itertools import pairwise

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import RelaxOptions, read_curve, relax

curve = read_curve("tangle.obj")
iterates = list(relax(curve, RelaxOptions(mesh="fixed")))

energies = [iterate.energy for iterate in iterates]
assert abs(energies[-1] - 4.0) < 1e-2
assert all(iterate.certified for iterate in iterates)

# %%
# The start, the end, and some of the stages between: the paper's row of pictures.
stages = [iterates[(len(iterates) - 1) * k // 5] for k in range(6)]
figure, axes = plt.subplots(2, 3, figsize=(9, 6), layout="constrained")
for ax, stage in zip(axes.flat, stages, strict=True):
    draw(ax, stage.curve, f"iterate {stage.index}: $E$ = {stage.energy:.1f}", width=2.5)

# %%
# The energy falls from each iterate to the next.
assert {len(iterate.curve) for iterate in iterates} == {len(curve)}
assert all(after <= before for before, after in pairwise(energies))
figure, ax = plt.subplots(figsize=(6, 3.5), layout="constrained")
ax.semilogy(energies)
ax.axhline(4.0, color="0.6", linestyle=":", label="circle")
ax.set(xlabel="iterate", ylabel="objective")
ax.legend()
plt.show()
