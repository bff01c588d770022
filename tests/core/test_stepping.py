"""Another method helps out where the one asked for finds no step, or strands nearly touch."""

from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import METHODS, Curve, RelaxOptions, stepping
from mobius_flow.core.descent import NoStep, Step
from mobius_flow.core.knots import knot
from mobius_flow.core.setup import start_problem
from mobius_flow.core.stepping import HELPER, HELPS, Stepper


class Stubborn:
    """A rule that never finds a step, and counts how often it is asked."""

    second_order = False

    def __init__(self):
        self.asked = 0

    def step(self, point, state):
        self.asked += 1
        return NoStep("it never does"), state


def stubborn(rule=None):
    return replace(METHODS["lbfgs"], rule=rule or Stubborn())


@pytest.fixture
def point():
    curve = knot("3_1")
    problem = start_problem(curve, RelaxOptions())
    return problem.at(problem.units.from_user(curve.vertices))


def test_the_helper_goes_on_where_a_method_is_stuck(point):
    rule = Stubborn()
    stepper = Stepper(stubborn(rule))
    for _ in range(HELPS + 1):
        step = stepper.step(point)
        assert isinstance(step, Step)
        assert step.point.problem is point.problem
        assert step.point.energy < point.energy
        point = step.point
    assert rule.asked == 1


def test_it_is_not_asked_twice_in_vain(point):
    stepper = Stepper(stubborn())
    for _ in range(HELPS + 1):
        stepper.step(point)  # the same point again and again: no progress
    step = stepper.step(point)
    assert isinstance(step, NoStep)
    assert step.reason == "it never does"


def test_strands_that_nearly_touch_are_for_the_helper():
    t = 2 * np.pi * np.arange(60) / 60
    eight = Curve(np.column_stack([np.sin(2 * t), np.cos(t), 1e-5 * np.sin(t)]))
    problem = start_problem(eight, RelaxOptions(edge_lengths="keep"))
    point = problem.at(problem.units.from_user(eight.vertices))
    rule = Stubborn()
    step = Stepper(stubborn(rule)).step(point)
    assert isinstance(step, Step)
    assert rule.asked == 0


def test_where_the_helper_finds_nothing_the_method_is_asked(point, monkeypatch):
    monkeypatch.setattr(stepping, "HELPER", stubborn())
    monkeypatch.setattr(stepping, "_nearly_touching", lambda point: True)
    assert isinstance(Stepper(METHODS["lbfgs"]).step(point), Step)


def test_energies_of_another_mesh_are_not_compared(point):
    stepper = Stepper(stubborn())
    for _ in range(HELPS + 1):
        stepper.step(point)
    assert isinstance(stepper.step(point), NoStep)
    stepper.restart()
    assert isinstance(stepper.step(point), Step)


def test_the_helper_and_penalised_problems_get_no_help(point):
    curve = knot("3_1")
    problem = start_problem(curve, RelaxOptions(method="penalty-lbfgs"))
    penalised = problem.at(problem.units.from_user(curve.vertices))
    assert isinstance(Stepper(stubborn()).step(penalised), NoStep)
    assert isinstance(Stepper(HELPER).step(point), Step)
