"""
Links of SnapPy, and a list of knots
====================================

`Curve.of` draws what other programs have, `knot_list` reads the tables that people download.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
from mobius_flow.core import Curve, knot_list, minimize
from mobius_flow.core.knots import knot, knot_type
from spherogram import Link

link = Curve.of(Link("L6a4"))
found = knot_type(link)
print(found)
assert found.names == ("L6a4",)

# %%
# A table as KnotInfo has it, with bars between its columns.
table = Path(tempfile.mkdtemp()) / "list.csv"
table.write_text(
    "name|pd_notation\n3_1|[[1,5,2,4],[3,1,4,6],[5,3,6,2]]\n4_1|[[4,2,5,1],[8,6,1,5],[6,3,7,4],[2,7,3,8]]\n"
)
listed = {name: minimize(knot(code, 60)) for name, code in knot_list(table).items()}
assert all(result.certified for result in listed.values())

# %%
# The link as it is drawn, and the knots relaxed.
shown = {"L6a4": link, **{name: result.curve for name, result in listed.items()}}
figure, axes = plt.subplots(1, 3, figsize=(9, 3), subplot_kw={"projection": "3d"}, layout="constrained")
for ax, (name, curve) in zip(axes, shown.items(), strict=True):
    for part in curve.components:
        ax.plot(*zip(*part, part[0], strict=True), linewidth=3)
    ax.set_title(name)
    ax.set_aspect("equal")
    ax.axis("off")
    ax.view_init(90, -90)
plt.show()
