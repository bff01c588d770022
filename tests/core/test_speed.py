"""What is measured is what a relaxation does; how long it takes is no matter for tests."""

import json
import math
import tracemalloc
from dataclasses import asdict

import numpy as np
import pytest
from mobius_flow.core import RelaxOptions
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.driver.solver import DENSE_UP_TO
from mobius_flow.core.errors import OptionError
from mobius_flow.core.knots import knot
from mobius_flow.core.knots.alexander import signature
from mobius_flow.core.speed import MIN_SIZE, SIZES, Machine, Row, bent_trefoil, exponents, fixed_mesh, speed

PHASES = ["lists", "energy", "derivative", "metric", "gradient", "retract", "proof", "iteration"]


def row(size: int, **options) -> Row:
    return next(speed([size], RelaxOptions(**options)))


@pytest.mark.parametrize("size", [MIN_SIZE, 201])
def test_the_curve_is_a_trefoil_that_is_to_be_moved(size):
    curve = bent_trefoil(size)
    check_embedded(curve)
    assert len(curve) == size
    assert signature(curve) == signature(knot("3_1"))
    assert curve.edge_lengths.max() > 2.0 * curve.edge_lengths.min()


@pytest.mark.parametrize("solver", ["dense", "hierarchical"])
def test_a_row_has_every_figure(solver):
    found = row(70, solver=solver)
    assert (found.vertices, found.solver) == (70, solver)
    assert list(found.seconds) == PHASES
    assert all(math.isfinite(value) and value >= 0.0 for value in found.seconds.values())
    assert json.loads(json.dumps(asdict(found)))["seconds"] == found.seconds


@pytest.mark.parametrize("method", ["cg", "trust-region", "flow-h1", "implicit-moebius", "penalty-nesterov"])
def test_every_kind_of_method_can_be_measured(method):
    assert row(60, method=method).solver == "dense"


def test_memory_has_room_for_the_dense_matrix_and_is_no_longer_traced_afterwards():
    assert row(200, solver="dense").peak_bytes > 2 * 8 * 200**2
    assert not tracemalloc.is_tracing()


def test_lists_and_values_are_made_anew_in_every_round(monkeypatch):
    """Nothing that one round has found may make the next one cheaper."""
    from mobius_flow.core.hierarchy import energy

    made = []
    original = energy.BlockList.of
    monkeypatch.setattr(energy.BlockList, "of", lambda *a: made.append(a[0]) or original(*a))
    monkeypatch.setattr("mobius_flow.core.speed.ROUNDS", 1)
    row(60, solver="hierarchical")
    once = len(made)
    made.clear()
    monkeypatch.setattr("mobius_flow.core.speed.ROUNDS", 4)
    row(60, solver="hierarchical")
    assert len(made) == once + 3 * 2  # one list for the energy, one for the metric


def test_the_hierarchical_solver_is_compared_with_the_dense_one():
    assert row(200, solver="dense").deviation is None
    off = row(1200, solver="hierarchical").deviation
    assert 0.0 < off.energy < 1e-5
    assert 0.0 < off.derivative < 1e-4
    assert 0.998 < off.cosine < 1.0
    assert 0.0 < off.norm < 0.05


def test_a_wrong_gradient_is_noticed(monkeypatch):
    from mobius_flow.core.hierarchy.energy import HierarchicalMoebiusEnergy

    original = HierarchicalMoebiusEnergy.value_and_derivative

    def wrong(self, curve):
        value, derivative = original(self, curve)
        return 1.01 * value, derivative + 0.1 * np.roll(derivative, 50, axis=0)

    monkeypatch.setattr(HierarchicalMoebiusEnergy, "value_and_derivative", wrong)
    off = row(200, solver="hierarchical").deviation
    assert off.energy > 5e-3
    assert off.derivative > 1e-2


def rows(solver: str, exponent: float, *sizes: int) -> list[Row]:
    return [Row(n, solver, {"iteration": 3e-5 * n**exponent}, 0, None) for n in sizes]


def test_exponents_are_those_of_large_sizes_by_solver():
    mixed = [
        *rows("dense", 7.0, 200, 1999),
        *rows("dense", 3.0, 2000, 2500),
        *rows("hierarchical", 1.1, 3000, 5000, 9000),
    ]
    assert exponents(mixed) == {"dense": pytest.approx(3.0), "hierarchical": pytest.approx(1.1)}


def test_one_large_size_has_no_exponent():
    assert exponents([*rows("dense", 2.0, 100, 200, 1000, 2000), *rows("hierarchical", 1.0, 5000)]) == {}


def test_the_default_sizes_show_both_solvers():
    assert min(SIZES) < DENSE_UP_TO < sorted(SIZES)[-2]
    assert fixed_mesh(SIZES, RelaxOptions()) == RelaxOptions(mesh="fixed")


def test_the_machine_has_a_speed():
    machine = Machine.measured()
    assert machine.product > 0.0
    assert machine.copy > 0.0


@pytest.mark.parametrize(
    ("sizes", "options", "expected"),
    [
        ([], {}, "sizes is empty"),
        ([200, 59], {}, "sizes has 59; the curve needs 60"),
        ([200, -1], {}, "sizes has -1"),
        ([200, 300, 200], {}, "sizes has 200 twice"),
        ([200_001], {}, "sizes has 200001; lbfgs has room and time for 200000"),
        ([20_000], {"solver": "dense"}, "room and time for 12000"),
        ([200], {"vertices": 300}, "fixed meshes"),
        ([200], {"mesh": "adaptive"}, "fixed meshes"),
        ([200], {"solver": "hierarchical", "method": "trust-region"}, "second derivative"),
    ],
)
def test_what_cannot_be_measured_is_refused_beforehand(sizes, options, expected):
    with pytest.raises(OptionError, match=expected):
        fixed_mesh(sizes, RelaxOptions(**options))
