"""Another method helps out where the chosen one finds no step."""

from dataclasses import replace

import pytest
from mobius_flow.core import METHODS, RelaxOptions, stepping
from mobius_flow.core.descent import NoStep, Step
from mobius_flow.core.knots import knot
from mobius_flow.core.setup import start_problem
from mobius_flow.core.stepping import HELPER, HELPS, Stepper


class Stubborn:
    """A rule that never finds a step, and counts how often it is asked."""

    second_order = False
    other_metrics = ()

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


def test_it_is_not_asked_where_its_matrices_do_not_fit(point, monkeypatch):
    monkeypatch.setattr(type(HELPER.metric), "most_vertices", len(point.vertices) - 1)
    assert isinstance(Stepper(stubborn()).step(point), NoStep)
    monkeypatch.setattr(type(HELPER.metric), "most_vertices", len(point.vertices))
    assert isinstance(Stepper(stubborn()).step(point), Step)


def test_it_is_not_asked_twice_in_vain(point):
    stepper = Stepper(stubborn())
    for _ in range(HELPS + 1):
        stepper.step(point)  # the same point again and again: no progress
    step = stepper.step(point)
    assert isinstance(step, NoStep)
    assert step.reason == "it never does"


def test_where_the_helper_finds_nothing_either_the_method_has_the_last_word(point, monkeypatch):
    monkeypatch.setattr(stepping, "HELPER", stubborn())
    step = Stepper(stubborn()).step(point)
    assert isinstance(step, NoStep)
    assert step.reason == "it never does"


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
