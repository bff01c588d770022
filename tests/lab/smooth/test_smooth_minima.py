"""Smooth curves at rest that are told apart, up to Möbius maps and isometries."""

from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.curve.measures import bending
from mobius_flow.core.driver.moves.balance import moebius_image
from mobius_flow.core.knots import knot
from mobius_flow.lab.smooth.fourier import FourierCurve
from mobius_flow.lab.smooth.minima import balanced, distinct
from mobius_flow.lab.smooth.rest import RestingCurve, at_rest, energy_of


@pytest.fixture(scope="module")
def trefoil():
    found = at_rest(minimize(knot("3_1", 90), RelaxOptions(vertices=90)).curve)
    assert found is not None
    return found


def image(rest, q):
    """A Möbius image with many modes, begun elsewhere and run through backwards."""
    polygon = rest.curve.polygon([1000])
    points = np.roll(moebius_image(polygon.vertices, q / np.linalg.norm(q))[::-1], 123, axis=0)
    return replace(rest, curve=FourierCurve.through(polygon.with_vertices(points), [90]))


Q = np.array([1.0, 0.1, -0.2, 0.15])


def test_a_balanced_image_bends_least_and_has_the_same_energy(trefoil):
    far = image(trefoil, Q)
    near = balanced(far)
    least, bent, straightened = (bending(each.curve.polygon([400])) for each in (balanced(trefoil), far, near))
    assert bent > 1.02 * straightened
    assert straightened == pytest.approx(least, rel=1e-5)
    assert energy_of(near.curve) == pytest.approx(trefoil.energy, abs=max(trefoil.error, 1e-9))
    assert np.linalg.norm(near.curve.polygon([400]).vertices, axis=1).max() == pytest.approx(1.0, abs=1e-3)


def test_modes_are_added_where_an_image_needs_them(trefoil):
    few = replace(trefoil, curve=image(trefoil, Q).curve.with_modes([30]))
    few = replace(few, energy=energy_of(few.curve), error=1e-10)
    assert balanced(few).curve.modes[0] > 30
    assert energy_of(balanced(few).curve) == pytest.approx(few.energy, abs=1e-9)


def test_images_are_the_same_and_other_energies_are_not(trefoil):
    mirrored = replace(trefoil, curve=trefoil.curve.mirrored, error=1.0)
    ends = [replace(trefoil, energy=trefoil.energy + 9.0), image(trefoil, Q), mirrored, replace(trefoil, error=0.0)]
    assert distinct(ends) == [[3, 1, 2], [0]]


@pytest.mark.parametrize(("apart", "groups"), [(1.9, [[0, 1]]), (2.1, [[0], [1]])])
def test_errors_of_both_count(trefoil, apart, groups):
    ends = [replace(trefoil, energy=trefoil.energy + more, error=1.0) for more in (0.0, apart)]
    assert distinct(ends) == groups


def test_links_whose_components_change_places_are_the_same():
    link = at_rest(minimize(knot("L4a1", 80), RelaxOptions(vertices=80)).curve)
    turned = replace(link, curve=FourierCurve(link.curve.coefficients[::-1]))
    assert distinct([link, turned]) == [[0, 1]]


def test_round_circles_are_the_same():
    circle = np.stack([np.zeros(3), [1.0, -1.0j, 0.0], *np.zeros((9, 3))])
    ends = [RestingCurve(FourierCurve((radius * circle,)), 4.0, 0.0) for radius in (1.0, 3.0)]
    assert distinct(ends) == [[0, 1]]


@pytest.mark.parametrize(("width", "groups"), [(0.6, [[0], [1]]), (0.99, [[0], [1]]), (0.9999, [[0, 1]])])
def test_other_shapes_of_equal_energy_are_others(trefoil, width, groups):
    wide = tuple(c * [1.0, width, 1.0] for c in trefoil.curve.coefficients)
    assert sorted(distinct([trefoil, replace(trefoil, curve=FourierCurve(wide))])) == groups
