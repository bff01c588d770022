"""
A table of knots, on all cores
==============================

Dask runs one relaxation per core. In a script of your own ``Client()`` starts processes on this machine, and
``Client("tcp://HOST:8786")`` uses a cluster; ``mobius-flow batch`` does the same, with files and proofs.
"""

import matplotlib.pyplot as plt
from dask.distributed import Client
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import knot

NAMES = ("0_1", "3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3")


def relaxed(name):
    """One row of the table."""
    result = minimize(knot(name), RelaxOptions(tolerance=1e-3))
    return name, len(result.curve), f"{result.final_energy:.3f}", result.status.value, result.certified


with Client(processes=False, threads_per_worker=1, dashboard_address=None) as client:
    rows = client.gather(client.map(relaxed, NAMES))
assert [row[0] for row in rows] == list(NAMES)
assert all(certified for *_, certified in rows)

figure, ax = plt.subplots(figsize=(8, 3), layout="constrained")
ax.set_axis_off()
ax.table(rows, colLabels=("knot", "vertices", "energy", "status", "certified"), loc="center").scale(1, 1.5)
plt.show()
