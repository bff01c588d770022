"""
Compare methods and metrics
===========================

Steepest descent depends on the inner product in which the gradient is taken. In L² the step size is bounded by a power
of the edge length; in the fractional Sobolev metric :math:`J_C` of the paper it is not. Quasi-Newton and trust-region
methods in that metric are faster still.
"""

import matplotlib.pyplot as plt
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import knot

METHODS = ("flow-l2", "flow-h1", "flow-h2", "flow-moebius", "cg", "lbfgs", "trust-region")

start = knot("5_1")
histories = {}
for method in METHODS:
    options = RelaxOptions(method=method, vertices=160, mesh="fixed", max_iterations=120)
    histories[method] = minimize(start, options).energies
least = min(min(energies) for energies in histories.values())
assert histories["lbfgs"][-1] - least < 1e-2 * (histories["flow-l2"][-1] - least)

figure, ax = plt.subplots(figsize=(7, 4.5), layout="constrained")
for method, energies in histories.items():
    ax.semilogy([energy - least for energy in energies], label=method)
ax.set(xlabel="iteration", ylabel=r"$E - E_{\min}$", ylim=(1e-4, None))
ax.legend(fontsize=8)
plt.show()
