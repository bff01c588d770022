"""
Identify a knot
===============

A knot may be given by the code of a diagram, here a Dowker–Thistlethwaite code. Random moves of single vertices, none
of which lets strands pass through each other, make it unrecognisable; invariants identify it all the same.
"""

import matplotlib.pyplot as plt
from drawing import draw
from mobius_flow.core import minimize
from mobius_flow.core.knots import knot, knot_type, scramble

curve = knot("DT: [4 8 10 2 6]")
scrambled = scramble(curve, seed=3)
relaxed = minimize(scrambled).curve

figure, axes = plt.subplots(1, 3, figsize=(10, 3.6), layout="constrained")
for ax, shown, title in zip(axes, (curve, scrambled, relaxed), ("from its code", "scrambled", "relaxed"), strict=True):
    found = knot_type(shown)
    assert found.proved
    assert found.names == knot_type(curve).names
    draw(ax, shown, f"{title}: {found}", width=2.5)
print("because of", *found.evidence, sep="\n  ")
plt.show()
