"""
A custom metric
===============

A metric is an inner product on functions along the curve, here
:math:`\\langle u, u\\rangle = \\int \\varepsilon\\,u'^2 + u^2` with a small weight ε. The weight decides which waves a
gradient step damps, and how long the step may be.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.knots import knot
from mobius_flow.core.solve.metrics import SparseInnerProduct, WithoutRule
from mobius_flow.core.solve.metrics.local import mass, stiffness


@dataclass(frozen=True)
class WeightedH1(WithoutRule):
    """ε ∫ u'² + ∫ u²."""

    weight: float
    name = "weighted-h1"
    description = "W^{1,2}, weighted"
    extends_penalty = True

    def at(self, curve):
        """The inner product for a curve, a sparse matrix."""
        return SparseInnerProduct(self.weight * stiffness(curve) + mass(curve))


curve = knot("3_1")
figure, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for weight in (1e-3, 1e-2, 1e-1, 1.0):
    options = RelaxOptions(method="cg", metric=WeightedH1(weight), vertices=100, mesh="fixed", max_iterations=60)
    result = minimize(curve, options)
    assert result.certified
    ax.semilogy(result.energies, label=f"ε = {weight:g}")
ax.set(xlabel="iteration", ylabel="objective")
ax.legend()
plt.show()
