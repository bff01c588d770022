"""
A custom energy
===============

A density :math:`F(r)` of pairs of points, given with its derivative, becomes an energy by a quadrature rule; here
:math:`F = r^{-3}`. The barrier between near strands and the proof of every step come with it.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.energies import KPointEnergy, Rule
from mobius_flow.core.energies.density import Partials
from mobius_flow.core.knots import knot


@dataclass(frozen=True)
class InverseCube:
    """F = 1/r³."""

    constant = 0.0  # what each component adds
    scale_exponent = -3.0  # F itself scales like length to this power

    def value(self, pairs):
        """F at pairs of points, whose squared distances are ``pairs.r2``."""
        return pairs.r2**-1.5

    def derivative(self, pairs):
        """dF/d(r²); a density may depend on tangents and arc length too."""
        return Partials(r2=-1.5 * pairs.r2**-2.5)


energy = KPointEnergy("inverse-cube", "1/r³ at the edges' midpoints", InverseCube(), Rule.gauss(1))
curve = knot("4_1")
results = {
    "moebius": minimize(curve, RelaxOptions(vertices=120)),
    "inverse-cube": minimize(curve, RelaxOptions(energy=energy, vertices=120, max_iterations=200)),
}

figure, axes = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for ax, (name, result) in zip(axes, results.items(), strict=True):
    assert result.certified
    assert result.energies[-1] < result.energies[0]
    draw(ax, result.curve, name)
plt.show()
