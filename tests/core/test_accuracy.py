"""The hierarchical solver looks at its own errors during a run."""

import pytest
from hard_curves import bent_trefoil
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.energies.hierarchy import HierarchicalMoebiusEnergy, SampledErrors, fields
from mobius_flow.core.knots import knot, overhand
from mobius_flow.core.knots.shapes import least_energies

INACCURATE = "the hierarchical solver misses the requested accuracy"


def short(vertices=1500, **options):
    wanted = RelaxOptions(**({"solver": "hierarchical", "mesh": "fixed", "max_iterations": 3} | options))
    return minimize(bent_trefoil(vertices), wanted)


def test_errors_are_in_outcome_and_report():
    result = short()
    errors = result.outcome.sampled_errors
    assert 0.0 < errors.energy.bound < 1e-6
    assert 0.0 < errors.gradient_norm.bound < 5e-5
    report = result.report()["sampled_errors"]
    assert report == {
        "energy": {"mean": errors.energy.mean, "standard_error": errors.energy.standard_error},
        "gradient_norm": {"mean": errors.gradient_norm.mean, "standard_error": errors.gradient_norm.standard_error},
        "order": 4,
    }
    assert ";" not in result.message


@pytest.mark.parametrize("solver", ["dense", "hierarchical"])  # with so few vertices most pairs are near
def test_sums_of_all_pairs_have_no_errors(solver):
    result = short(200, solver=solver)
    assert result.outcome.sampled_errors is None
    assert result.report()["sampled_errors"] is None


def test_expansions_are_tightened_for_the_accuracy_asked_for():
    result = short(accuracy=1e-5)
    errors = result.outcome.sampled_errors
    assert errors.order == 6
    assert errors.energy.bound < 1e-7
    assert errors.gradient_norm.bound < 5e-6
    assert "far-field expansions were raised to order 6 for the requested accuracy" in result.message
    assert INACCURATE not in result.message
    assert len(result.energies) == 4
    assert result.certified


@pytest.mark.slow
def test_what_cannot_be_reached_is_told():
    assert INACCURATE in short(accuracy=1e-12).message


def wrong_kernels(monkeypatch):
    """One Taylor coefficient of the logarithm is wrong."""
    original = fields.kernel_derivatives

    def kernels(*arguments):
        square, log = original(*arguments)
        log[4] *= 1.01
        return square, log

    monkeypatch.setattr(fields, "kernel_derivatives", kernels)


def wrong_derivative(monkeypatch):
    original = HierarchicalMoebiusEnergy.value_and_derivative

    def value_and_derivative(self, curve):
        value, derivative = original(self, curve)
        return value, 1.01 * derivative

    monkeypatch.setattr(HierarchicalMoebiusEnergy, "value_and_derivative", value_and_derivative)


def wrong_value(monkeypatch):
    original = HierarchicalMoebiusEnergy.value
    monkeypatch.setattr(HierarchicalMoebiusEnergy, "value", lambda self, curve: (1.0 + 3e-6) * original(self, curve))


@pytest.mark.parametrize("defect", [pytest.param(wrong_kernels, marks=pytest.mark.slow), wrong_derivative, wrong_value])
def test_a_defect_is_noticed(defect, monkeypatch):
    defect(monkeypatch)
    message = short(max_iterations=1).message
    assert f"{INACCURATE}: against dense sums over a sample its relative errors are up to " in message
    assert message.endswith("in the gradient norm; the dense solver has no such error")


@pytest.mark.slow
def test_every_mesh_and_the_end_are_looked_at(monkeypatch):

    looked_at = []
    original = SampledErrors.at

    def at(energy, curve, *rest):
        looked_at.append(len(curve))
        return original(energy, curve, *rest)

    monkeypatch.setattr(SampledErrors, "at", at)
    short(1700)
    assert looked_at == [1700, 1700]
    looked_at.clear()
    short(1700, max_iterations=31, mesh="auto", tolerance=1e-2)
    assert looked_at == [1700], "it ends where it has all vertices again; the coarse mesh is too small for errors"


def test_the_error_of_an_energy_that_is_not_exact(monkeypatch):
    from mobius_flow.cli.relax import _energies

    told = dict(_energies(short(300), short(300).curve, 1e-4))
    assert "(mesh error about " in told["energy"]
    monkeypatch.setattr("mobius_flow.core.energies.hierarchy.energy.EXACT_UP_TO", 200)
    result = short(300)
    told = dict(_energies(result, result.curve, 1e-4))
    assert told["energy"].endswith(f" (± {100.0 * result.final_energy_error:.1g} %, from a sample)")
    assert result.report()["final_energy_error"] == result.final_energy_error > 0.0


def test_the_error_of_the_mesh_is_the_distance_from_the_smooth_curve():
    result = minimize(knot("3_1"), RelaxOptions(vertices=120))
    assert result.mesh_error == pytest.approx(abs(result.final_energy - least_energies()["3_1"][0]), rel=0.1)
    assert minimize(overhand(40), RelaxOptions(vertices=40, max_iterations=0)).mesh_error is None
