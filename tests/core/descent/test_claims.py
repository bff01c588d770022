"""What the paper and the README claim about the methods."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from descent_contracts import with_geometry
from mobius_flow.core import METHODS, Curve, OptionError, RelaxOptions, Status, minimize, relax
from mobius_flow.core.descent.geometry import Geometry
from mobius_flow.core.descent.hessian import lagrangian_hessian, projected_conjugate_gradient
from mobius_flow.core.driver.moves.rest import stability
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.energies import ENERGIES, MoebiusEnergy
from mobius_flow.core.knots import knot
from shapes import torus_trefoil
from taylor import taylor_slope


def point_at(curve, **options):
    problem = start_problem(curve, RelaxOptions(**options))
    return problem.at(problem.units.from_user(curve.vertices))


def iterations(method, n, limit):
    options = RelaxOptions(method=method, tolerance=1e-3, vertices=n, max_iterations=limit)
    result = minimize(torus_trefoil(n), options)
    return len(result.energies) - 1 if result.status is Status.CONVERGED else limit


@pytest.mark.parametrize("method", ["flow-moebius", "lbfgs", "trust-region"])
def test_iterations_do_not_depend_on_the_mesh(method):
    counts = [iterations(method, n, 60) for n in (80, 160, 320)]
    assert counts[0] < 60
    assert max(counts) < 1.3 * min(counts) + 1


def test_the_l2_flow_depends_on_the_mesh():
    """After as many steps, the finer mesh is far behind: L² steps are bounded by a power of the edge length."""
    left = []
    for n in (40, 80):
        result = minimize(torus_trefoil(n), RelaxOptions(method="flow-l2", vertices=n, max_iterations=60))
        best = minimize(torus_trefoil(n), RelaxOptions(vertices=n)).energies[-1]
        left.append((result.energies[-1] - best) / (result.energies[0] - best))
    assert left[1] > 1.5 * left[0] > 0
    assert iterations("flow-l2", 80, 60) == 60
    assert iterations("flow-moebius", 80, 60) < 20


@pytest.mark.parametrize(("method", "most"), [("penalty-cg", 20), ("penalty-nesterov", 25)])
def test_penalised_methods_take_no_steps_that_gain_nothing(method, most):
    """With c₁ = 10⁻⁴ in the Wolfe conditions, which lets them pass, these are 111 and 51 iterations."""
    assert minimize(knot("trefoil", 48), RelaxOptions(method=method, vertices=48, max_iterations=most)).status is (
        Status.CONVERGED
    )


def test_the_papers_method_is_section_6_and_nothing_else():
    """Freedman's unknot becomes a circle on its own mesh and energy, by steps that meet Armijo's rule with ½."""
    iterates = []
    options = RelaxOptions(method="paper", tolerance=0.01)
    result = minimize(knot("freedman", 420), options, iterates.append)
    assert result.status is Status.CONVERGED
    assert result.certified
    assert result.energies[-1] < 4.1
    assert {(each.method, len(each.path)) for each in iterates[1:]} == {("paper", 1)}
    for before, after in pairwise(iterates):
        gain = 0.5 * after.step_size * before.gradient_norm**2
        assert after.energy <= before.energy - gain + 1e-9
        assert after.edge_length_error < 1e-10
    for each in iterates[:: len(iterates) - 1]:
        assert each.energy == pytest.approx(MoebiusEnergy().value(each.curve), rel=1e-12)
    with_barrier = next(relax(knot("freedman", 420), replace(options, barrier="on"))).energy
    assert abs(with_barrier - result.energies[0]) > 1.0


@pytest.fixture(scope="module")
def minimum():
    return minimize(torus_trefoil(120), RelaxOptions(method="trust-region", tolerance=1e-11, vertices=120))


def test_trust_region_ends_superlinearly(minimum):
    options = RelaxOptions(method="trust-region", tolerance=1e-11, vertices=120)
    norms = [iterate.gradient_norm for iterate in relax(torus_trefoil(120), options)]
    assert norms[-1] <= 1e-9
    ratios = np.divide(norms[-2:], norms[-3:-1])
    assert ratios[1] < 0.1
    assert ratios[1] < ratios[0] or ratios.max() < 1e-2
    assert minimum.status is Status.CONVERGED


def test_newtons_direction_does_not_see_what_constraints_balance(minimum):
    """However much of that there is: its rounding would end the iteration at once."""
    point = point_at(minimum.curve.with_vertices(minimum.curve.vertices + 1e-3 * np.sin(minimum.curve.vertices)))
    hessian, space, rng = lagrangian_hessian(point), point.tangent_space, np.random.default_rng(1)
    balanced = space.constraints.apply_transpose(1e3 * rng.normal(size=len(point.multipliers)))
    one, other = (
        projected_conjugate_gradient(hessian, right, space, 1e-8, 200)
        for right in (-point.lagrangian_derivative(point.multipliers), balanced - point.derivative)
    )
    assert space.norm(one - other) < 1e-4 * space.norm(one)


def test_the_gradients_norm_is_that_of_the_gradient_at_a_minimum_too(minimum):
    """Where DE is all multipliers, whose rounding DE·u would be: 0 in half of all cases."""
    point = point_at(minimum.curve)
    assert 0.0 < point.gradient_norm < 1e-8
    assert point.gradient_norm == pytest.approx(point.tangent_space.norm(point.gradient), rel=0.01)


def test_lagrangian_hessian_has_slope_three_on_the_constraint_set():
    """E along the feasible curve Q(t) = restore(P + t v), v tangent: E' = DE·v and E'' = ⟨v, D²L v⟩ at t = 0.

    By (42) alone, whose corrections are orthogonal to the gradient: others bend Q(t) up or down the slope.
    """
    even = minimize(torus_trefoil(60), RelaxOptions(max_iterations=3, vertices=60)).curve
    point = with_geometry(point_at(even), Geometry(small=1e-300))
    rng = np.random.default_rng(23)
    v = point.tangent_space.project(rng.normal(size=point.vertices.shape))
    v /= np.abs(v).max()
    hessian = lagrangian_hessian(point)

    def along(t):
        trial = point.retract(point.vertices + t * v, point.residual)
        return trial.energy

    terms = [point.energy, np.sum(point.derivative * v), np.sum(v * hessian(v))]
    assert taylor_slope(along, terms, largest=0.01, halvings=12) == pytest.approx(3, abs=0.25)
    wrong = [point.energy, np.sum(point.derivative * v), 1.1 * np.sum(v * hessian(v))]
    assert taylor_slope(along, wrong, largest=0.01, halvings=12) < 2.5


def test_trefoil_is_a_minimum_with_four_flat_and_two_soft_modes(minimum):
    found = stability(point_at(minimum.curve))
    assert found.index == 0
    values = found.modes.values
    np.testing.assert_allclose(values[:4], 0, atol=1e-9)
    np.testing.assert_allclose(values[4:6], 11 / 120**2, rtol=0.1)
    assert values[6] == pytest.approx(0.28, rel=0.05)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"energy": 5}, "energy is 5; it must be a name or an energy"),
        ({"energy": MoebiusEnergy}, "it must be a name or an energy"),
        ({"edge_lengths": [1.0, -1.0]}, "a name or as many numbers above 0 as there are edges"),
        ({"edge_lengths": np.ones(59), "vertices": 60}, "has 59 numbers, but the refined curve has 60 edges"),
        ({"quadrature_points": 2, "metric": "l2"}, "has no such rule"),
        ({"penalty": 5.0}, "has no penalty"),
        ({"method": "trust-region", "terms": [("bending", 0.1)]}, "second derivative"),
        ({"method": "penalty-cg", "stability": True}, "penalises lengths"),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(OptionError, match=message):
        relax(torus_trefoil(60), RelaxOptions(**options))


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize(("method", "most"), [("trust-region", 8), ("implicit-moebius", 20), ("implicit-h1", 20)])
def test_every_energy_has_methods_of_second_order_and_an_index(energy, method, most):
    """A bent ring becomes round, a minimum; as fast as it does for `moebius`."""
    t = 2.0 * np.pi * np.arange(30) / 30
    x, y = np.cos(t) + 0.2 * np.cos(2 * t + 0.5), np.sin(t) - 0.1 * np.sin(3 * t)
    ring, tolerance = Curve(np.column_stack([x, y, np.sin(2 * t) / 3])), 1e-9 if method == "trust-region" else 1e-6
    options = RelaxOptions(energy=energy, method=method, tolerance=tolerance, vertices=30, mesh="fixed", stability=True)
    result = minimize(ring, replace(options, max_iterations=most))
    assert result.status is Status.CONVERGED
    assert result.outcome.negative_eigenvalues == 0
    radii = np.linalg.norm(result.curve.vertices - result.curve.vertices.mean(axis=0), axis=1)
    assert np.ptp(radii) < 1e-4 * radii.mean()


@pytest.mark.parametrize("energy", ["edge", "vertex", "moebius-k2", "tangent-point"])
@pytest.mark.parametrize("metric", ["l2", "h1", "h3-2", "h2", "moebius"])
def test_every_energy_in_every_metric_goes_down(energy, metric):
    options = RelaxOptions(energy=energy, metric=metric, max_iterations=3, vertices=60)
    energies = minimize(torus_trefoil(60), options).energies
    assert len(energies) == 4
    assert energies[-1] < energies[0]


@pytest.mark.parametrize("method", [name for name, method in METHODS.items() if not method.geometry.prescribes])
def test_penalised_methods_in_the_l2_metric_are_not_extended(method):
    """Footnote 8 of the paper: the gradient of the penalised energy in L² alone."""
    options = RelaxOptions(method=method, metric="l2", max_iterations=3, vertices=60)
    point = point_at(torus_trefoil(60), method=method, metric="l2")
    mass = point.problem.metric.at(point.curve)
    np.testing.assert_allclose(mass.apply(point.gradient), point.derivative, atol=1e-9 * np.abs(point.derivative).max())
    assert minimize(torus_trefoil(60), options).energies[-1] < point.energy


@pytest.mark.parametrize("energy", ["edge", "vertex", "tangent-point"])
def test_every_objective_is_a_barrier(energy):
    """A strand that comes near another between its quadrature points costs energy that grows without bound."""
    objective = point_at(torus_trefoil(60), energy=energy).problem.objective
    values = []
    for gap in (1e-2, 1e-4, 1e-6):
        first = [[0, 0, 0], [1, 0, 0], [1, 3, 0], [-1, 3, 0], [-1, 0, 0]]
        second = [[0.3, -0.6, gap], [0.5, 0.4, gap], [0.5, 0.4, 3], [3, 0.4, 3], [3, -0.6, 3], [0.3, -0.6, 3]]
        values.append(objective.value(Curve.from_components([first, second])))
    assert values[0] + 10 < values[1] < values[2] - 10
