"""Another method helps out where the one asked for finds no step."""

from dataclasses import replace

import pytest
from changed_moves import change
from mobius_flow.core import METHODS, RelaxOptions, Status, minimize
from mobius_flow.core.curve import refine
from mobius_flow.core.descent import NoStep
from mobius_flow.core.driver import run as run_module
from mobius_flow.core.driver.move import Change
from mobius_flow.core.driver.moves import Fallback
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import knot

STUCK = NoStep("it never does")
HELPER, HELPS = Fallback.method, Fallback.steps


class Stubborn:
    """A rule that never finds a step, and counts how often it is asked."""

    second_order = False
    other_metrics = ()

    def __init__(self):
        self.asked = 0

    def step(self, point, state):
        self.asked += 1
        return STUCK, state


@pytest.fixture
def rule(monkeypatch):
    stubborn = Stubborn()
    methods = {name: replace(METHODS[name], rule=stubborn) for name in ("lbfgs", "paper", "penalty-lbfgs")}
    monkeypatch.setattr(run_module, "METHODS", methods | {HELPER.name: HELPER})
    return stubborn


def run_by(method="lbfgs", vertices=None):
    options = RelaxOptions(method=method)
    curve = refine(knot("3_1"), vertices)
    return Run(start_problem(curve, options), curve, options)


def test_the_helper_goes_on_where_a_method_is_stuck_and_its_steps_are_marked(rule):
    iterates = []
    result = minimize(knot("3_1"), RelaxOptions(max_iterations=HELPS + 2), iterates.append)
    assert [iterate.method for iterate in iterates] == ["lbfgs"] + [HELPER.name] * (HELPS + 2)
    assert result.fallback_steps == tuple(range(1, HELPS + 3))
    assert result.report()["fallback_steps"] == list(result.fallback_steps)
    assert all(a > b for a, b in zip(result.energies, result.energies[1:], strict=False))
    assert result.certified
    assert rule.asked == 2


def test_it_is_not_asked_where_its_matrices_do_not_fit(rule, monkeypatch):
    run = run_by()
    monkeypatch.setattr(type(HELPER.metric), "most_vertices", len(run.point.vertices) - 1)
    assert Fallback(run)(STUCK) is STUCK
    monkeypatch.setattr(type(HELPER.metric), "most_vertices", len(run.point.vertices))
    assert Fallback(run)(STUCK).method is HELPER


def test_it_is_not_asked_twice_in_vain(rule):
    run = run_by()
    fallback = Fallback(run)
    list(run.change(fallback(STUCK)))
    assert run.method is HELPER
    list(run.change(fallback(STUCK)))
    assert run.method.rule is rule
    assert fallback(STUCK) is STUCK


def test_where_the_helper_finds_nothing_either_the_method_has_the_last_word(rule, monkeypatch):
    change(monkeypatch, Fallback, method=replace(HELPER, rule=Stubborn()))
    result = minimize(knot("3_1"))
    assert result.status is Status.STALLED
    assert result.message.startswith("stalled: it never does; ")
    assert len(result.energies) == 1


def test_energies_of_another_mesh_are_not_compared(rule):
    run = run_by()
    fallback = Fallback(run)
    for _ in range(2):
        list(run.change(fallback(STUCK)))
    assert fallback(STUCK) is STUCK
    list(run.change(Change(point=run_by(vertices=150).point)))
    assert fallback(STUCK).method is HELPER


@pytest.mark.parametrize("method", ["paper", "penalty-lbfgs", HELPER.name])
def test_the_helper_the_paper_and_penalised_problems_get_no_help(rule, method):
    assert Fallback(run_by(method))(STUCK) is STUCK


def test_quadrature_points_are_for_the_method_and_not_for_the_helper(rule):
    """The helper's metric has no such rule, which nobody asked for."""
    result = minimize(knot("3_1"), RelaxOptions(quadrature_points=2, max_iterations=2))
    assert result.fallback_steps == (1, 2)
