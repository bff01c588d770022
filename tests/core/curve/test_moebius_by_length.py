"""Energy per length: its integral is the energy, and a circle has the same everywhere."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.energies import MoebiusEnergy
from mobius_flow.core.energies.moebius import moebius_by_length
from shapes import hopf_link, regular_polygon, torus_trefoil


def of_all_pairs(curve):
    """W_IJ one by one, as in the docstring of `moebius`."""
    e, ell, m = curve.edge_vectors, curve.edge_lengths, curve.midpoints
    energy = np.zeros(len(curve))
    for i in range(len(curve)):
        for j in range(len(curve)):
            if curve.mesh.disjoint(np.array(i), np.array(j)):
                chord = m[i] - m[j]
                s = 1 / (chord @ chord)
                energy[i] += (ell[i] * ell[j] + e[i] @ e[j]) * s - 2 * (chord @ e[i]) * (chord @ e[j]) * s**2
    return energy / ell


@pytest.mark.parametrize("curve", [torus_trefoil(40), hopf_link(12)], ids=["trefoil", "link"])
def test_it_is_the_sum_over_all_pairs(curve):
    np.testing.assert_allclose(moebius_by_length(curve), of_all_pairs(curve), rtol=1e-10)


@pytest.mark.parametrize("n", [60, 400])
def test_its_integral_is_the_energy(n):
    curve = torus_trefoil(n)
    assert moebius_by_length(curve) @ curve.edge_lengths + 4 == pytest.approx(MoebiusEnergy().value(curve), rel=1e-12)


def test_a_circle_has_none():
    np.testing.assert_allclose(moebius_by_length(regular_polygon(50)), 0, atol=1e-12)


def test_it_is_per_length():
    curve = torus_trefoil(40)
    larger = Curve(4 * curve.vertices)
    np.testing.assert_allclose(4 * moebius_by_length(larger), moebius_by_length(curve), rtol=1e-12)
