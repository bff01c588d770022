"""The least energy that relaxations lead to: 4 for each component unless it seems knotted."""

import numpy as np
import pytest
from mobius_flow.addon.engine.rest import CIRCLE, target_of
from mobius_flow.core import Curve, Mesh, MoebiusEnergy, Obstacle, RelaxOptions, minimize
from mobius_flow.core.knots import knot, overhand
from shapes import hopf_link, torus_trefoil
from tasks import wanted

MOEBIUS = RelaxOptions()


@pytest.mark.parametrize("name", ["culprit", "goeritz", "thistlethwaite"])
def test_unknots_may_become_circles(name):
    target = target_of(knot(name), MOEBIUS)
    assert (target.energy, target.label) == (4.0, "circle = 4")


@pytest.mark.parametrize("name", ["3_1", "4_1", "8_19"])
def test_knots_do_not(name):
    assert target_of(knot(name), MOEBIUS) is None


def test_a_link_has_a_circles_energy_for_each_component():
    target = target_of(hopf_link(24), MOEBIUS)
    assert (target.energy, target.label) == (8.0, "floor = 8")
    assert minimize(hopf_link(24)).final_energy > target.energy


def test_the_type_of_curves_with_very_many_vertices_is_left_open():
    assert target_of(torus_trefoil(60), MOEBIUS, most=59).label == "circle = 4"
    assert target_of(torus_trefoil(59), MOEBIUS, most=59) is None


def test_other_energies_have_other_minima():
    assert target_of(knot("culprit"), RelaxOptions(energy="edge")) is None


@pytest.mark.parametrize("n", [50, 400])
def test_it_is_the_energy_of_the_circle(n):
    angles = 2 * np.pi * np.arange(n) / n
    circle = Curve(np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]))
    assert MoebiusEnergy().value(circle) == pytest.approx(CIRCLE, rel=10 / n**2)


def test_an_arc_may_become_straight():
    target = target_of(overhand(60), MOEBIUS)
    assert (target.energy, target.label) == (0.0, "straight = 0")
    segment = Curve(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), Mesh((3,), (False,)))
    assert MoebiusEnergy().value(segment) == pytest.approx(target.energy, abs=1e-12)


def test_arcs_add_nothing_to_the_floor():
    link = Curve.from_components([*hopf_link(24).components, overhand(60).vertices + 20], (True, True, False))
    assert target_of(link, MOEBIUS).label == "floor = 8"


def test_pins_and_obstacles_keep_curves_from_it():
    assert target_of(*wanted(overhand(60), pins=(0, 59))) is None
    post = Obstacle([[0.0, 0.0, -9.0], [0.0, 0.0, 9.0]], [[0, 1]])
    assert target_of(*wanted(knot("culprit"), avoid=(post,))) is None
