"""Balls enclose what doubles say."""

import numpy as np
import pytest
from fourier_curves import values
from mobius_flow.core.knots.shapes import shapes

balls = pytest.importorskip("mobius_flow.lab.smooth.covering")
TREFOIL = shapes()["3_1"].coefficients[0]


@pytest.mark.parametrize("nodes", [1, 9, 100])  # fewer than modes too, where frequencies are folded
@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("shift", [0, 1])
def test_points_are_those_of_the_series(nodes, order, shift):
    high, low = balls.points(TREFOIL, nodes, order, shift)
    t = (np.arange(nodes) + shift / 2) / nodes
    np.testing.assert_allclose(high, values(TREFOIL, t, order).real.T, rtol=1e-11, atol=1e-9)
    with balls.precise():
        for j in range(0, nodes, 8):
            wave = [balls.acb(balls.arb(k * (2 * j + shift)) / nodes).exp_pi_i() for k in range(len(TREFOIL))]
            wave = [w * balls.acb(0, 2 * k * balls.arb.pi()) ** order for k, w in enumerate(wave)]
            for a in range(3):
                exact = sum((balls.acb(complex(c)) * w for c, w in zip(TREFOIL[:, a], wave, strict=True)), balls.acb(0))
                assert abs(float(exact.real - high[a, j] - low[a, j])) < 2.0**-100 * max(1.0, abs(high[a, j]))
