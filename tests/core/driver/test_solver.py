"""The options solver and accuracy: what they promise, and what they do not go together with."""

import pytest
from hard_curves import bent_trefoil
from mobius_flow.core import Curve, Iterate, Objective, OptionError, RelaxOptions, relax
from mobius_flow.core.curve import refine
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.driver.solver import Solver
from mobius_flow.core.energies.hierarchy import HierarchicalMoebiusEnergy
from mobius_flow.core.knots import knot
from shapes import torus_trefoil


def start(**options: object) -> Iterate:
    return next(relax(torus_trefoil(300), RelaxOptions(vertices=300, **options)))  # type: ignore[arg-type]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-8])
def test_solvers_agree_as_far_as_the_option_says(accuracy: float) -> None:
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
def test_what_needs_dense_matrices_is_refused_in_one_sentence(options: dict[str, object], obstacle: str) -> None:
    with pytest.raises(OptionError, match=f"^{obstacle}; solver='hierarchical' does without: leave it out$"):
        start(solver="hierarchical", **options)


def test_a_search_compares_energies_by_the_block_list_of_its_start() -> None:
    """Between the lists of two curves the value jumps, by more than the last steps of a relaxation gain."""
    curve, options = torus_trefoil(2000), RelaxOptions(vertices=2000, solver="hierarchical")
    run = Run(start_problem(curve, options), curve, options)
    trial = run.problem.at(run.point.vertices * [1.0, 1.0, 0.95])
    afresh = Objective.of(HierarchicalMoebiusEnergy()).value(trial.curve)
    assert 1e-9 * afresh < abs(trial.energy - afresh) < 1e-6 * afresh


def is_hierarchical(curve: Curve, **options: object) -> bool:
    """By what a problem is solved that starts from a curve."""
    wanted = RelaxOptions(**options)  # type: ignore[arg-type]
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
def test_the_solver_is_the_one_that_was_measured_to_be_faster(name: str, vertices: int, faster: bool) -> None:
    """Processor seconds of dense iterations against hierarchical ones; the curve decides, not only its size."""
    curve = bent_trefoil(vertices) if name == "bent" else refine(knot(name), vertices)
    assert len(curve) == vertices
    assert is_hierarchical(curve) is faster
    assert not is_hierarchical(curve, solver="dense")
    assert is_hierarchical(curve, solver="hierarchical")
    assert not is_hierarchical(curve, method="trust-region")


def test_small_and_large_curves_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    def counted(curve: Curve) -> int:
        raise AssertionError("blocks are counted")

    monkeypatch.setattr("mobius_flow.core.driver.solver.block_count", counted)
    assert not is_hierarchical(torus_trefoil(Solver.dense_up_to))
    assert is_hierarchical(torus_trefoil(Solver.hierarchical_from + 1))
    with pytest.raises(AssertionError):
        is_hierarchical(torus_trefoil(Solver.dense_up_to + 1))
