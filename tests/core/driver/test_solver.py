"""Which solver a run has, and which helper where its method is stuck."""

from dataclasses import replace

import pytest
from changed_moves import change
from hard_curves import bent_trefoil
from mobius_flow.core import METHODS, Objective, OptionError, RelaxOptions, Status, minimize, relax
from mobius_flow.core.curve import refine
from mobius_flow.core.descent import NoStep
from mobius_flow.core.driver import run as run_module
from mobius_flow.core.driver.moves import Fallback
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.driver.solver import Solver
from mobius_flow.core.energies.hierarchy import HierarchicalMoebiusEnergy
from mobius_flow.core.knots import knot
from shapes import torus_trefoil


def start(**options):
    return next(relax(torus_trefoil(300), RelaxOptions(vertices=300, **options)))


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-8])
def test_solvers_agree_as_far_as_the_option_says(accuracy):
    """The hierarchical metric is another one, and the error of the energy does not depend on the accuracy."""
    dense, fast = start(solver="dense"), start(solver="hierarchical", accuracy=accuracy)
    assert fast.energy == pytest.approx(dense.energy, rel=2e-6)
    assert fast.gradient_norm == pytest.approx(dense.gradient_norm, rel=0.03)
    exact = start(solver="hierarchical", accuracy=1e-12)
    assert fast.gradient_norm == pytest.approx(exact.gradient_norm, rel=accuracy)


@pytest.mark.parametrize(
    ("options", "obstacle"),
    [
        ({"method": "trust-region"}, "trust-region needs exact second derivatives"),
        ({"quadrature_points": 2}, "2 Gauss points need all pairs of edges one by one"),
        ({"energy": "tangent-point"}, "energy 'tangent-point' needs all pairs of edges one by one"),
    ],
)
def test_what_needs_dense_matrices_is_refused_in_one_sentence(options, obstacle):
    with pytest.raises(OptionError, match=f"^{obstacle}; solver='hierarchical' does without: leave it out$"):
        start(solver="hierarchical", **options)


def test_a_search_compares_energies_by_the_block_list_of_its_start():
    """Between the lists of two curves the value jumps, by more than the last steps of a relaxation gain."""
    curve, options = torus_trefoil(2000), RelaxOptions(vertices=2000, solver="hierarchical")
    run = Run(start_problem(curve, options), curve, options)
    trial = run.problem.at(run.point.vertices * [1.0, 1.0, 0.95])
    afresh = Objective.of(HierarchicalMoebiusEnergy()).value(trial.curve)
    assert 1e-9 * afresh < abs(trial.energy - afresh) < 1e-6 * afresh


def is_hierarchical(curve, **options):
    """By what a problem is solved that starts from a curve."""
    wanted = RelaxOptions(**options)
    problem = start_problem(curve, wanted)
    chosen = isinstance(problem.objective.energy, HierarchicalMoebiusEnergy)
    assert problem.solver.hierarchical == chosen
    return chosen


@pytest.mark.parametrize(
    ("name", "vertices", "faster"),
    [
        ("bent", 1300, False),
        ("bent", 2000, True),
        ("8_19", 2000, False),
        ("8_19", 3000, True),
        ("ochiai-1", 2400, False),
        ("ochiai-1", 3500, True),
        ("freedman-he-wang", 2368, False),
        ("freedman-he-wang", 3500, False),
    ],
)
def test_the_solver_is_the_one_that_was_measured_to_be_faster(name, vertices, faster):
    """Processor seconds of dense iterations against hierarchical ones; the curve decides, not only its size."""
    curve = bent_trefoil(vertices) if name == "bent" else refine(knot(name), vertices)
    assert len(curve) == vertices
    assert is_hierarchical(curve) is faster
    assert not is_hierarchical(curve, solver="dense")
    assert is_hierarchical(curve, solver="hierarchical")
    assert not is_hierarchical(curve, method="trust-region")


def test_a_hierarchical_energy_that_is_given_keeps_its_settings():
    given = RelaxOptions(energy=HierarchicalMoebiusEnergy(order=6), solver="hierarchical")
    assert start_problem(torus_trefoil(60), given).objective.energy.order == 6


def test_small_and_large_curves_are_not_looked_at(monkeypatch):
    def counted(curve):
        raise AssertionError("blocks are counted")

    monkeypatch.setattr("mobius_flow.core.driver.solver.block_list", counted)
    assert not is_hierarchical(torus_trefoil(Solver.dense_up_to))
    assert is_hierarchical(torus_trefoil(Solver.hierarchical_from + 1))
    with pytest.raises(AssertionError):
        is_hierarchical(torus_trefoil(Solver.dense_up_to + 1))


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
    run.method = fallback(STUCK).method
    assert run.method is HELPER
    run.method = fallback(STUCK).method
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
        run.method = fallback(STUCK).method
    assert fallback(STUCK) is STUCK
    list(run.enter(run_by(vertices=150).point))
    assert fallback(STUCK).method is HELPER


def test_another_view_is_remembered_only_if_the_problem_is_the_same():
    run = run_by()
    run.accept(run.step())
    for changes, kept in (({"radius": None}, True), ({"metric": HELPER.metric}, False)):
        run.view(run.point.changing(**changes))
        assert (run.memory.memory is not None) == kept


@pytest.mark.parametrize("method", ["paper", "penalty-lbfgs", HELPER.name])
def test_the_helper_the_paper_and_penalised_problems_get_no_help(rule, method):
    assert Fallback(run_by(method))(STUCK) is STUCK


def test_quadrature_points_are_for_the_method_and_not_for_the_helper(rule):
    """The helper's metric has no such rule, which nobody asked for."""
    result = minimize(knot("3_1"), RelaxOptions(quadrature_points=2, max_iterations=2))
    assert result.fallback_steps == (1, 2)
