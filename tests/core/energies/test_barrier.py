"""The barrier: its local contributions, its pairs, its smoothness."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mobius_flow.core import Curve, MoebiusEnergy, Objective
from mobius_flow.core.energies import Barrier
from mobius_flow.core.energies.barrier import closeness, cutoff, exact, midpoint, near_pairs
from mobius_flow.core.energies.edge_pairs import EdgePairs, change, stepped
from mobius_flow.core.knots import knot
from shapes import crossing, lattice_knot, regular_polygon
from taylor import taylor_slope

BARRIER = Barrier()


def one_pair(x0, x1, y0, y1):
    """One pair of edges, by way of a curve that has them as edges 0 and 4."""
    far = [[50.0, 0, 0], [50.0, 50.0, 0], [0, 50.0, 50.0], [0, 0, 90.0], [-70.0, 0, 0]]
    curve = Curve([x0, x1, far[0], far[1], y0, y1, *far[2:]])
    return EdgePairs.of(curve.mesh, curve.vertices, np.array([0]), np.array([4]))


@pytest.mark.parametrize(
    ("gap", "by_midpoints", "by_integral"),
    [(0.5, 4.188574125, 2.769582087), (0.1, 13.993463424, 11.235155010), (0.02, 2.124182083, 21.440754439)],
)
def test_one_pair(gap, by_midpoints, by_integral):
    pair = one_pair([0, 0, 0], [1, 0, 0], [0.3, -0.6, gap], [0.5, 0.4, gap])
    assert midpoint(pair).value[0] == pytest.approx(by_midpoints, abs=1e-9)
    assert exact(pair).value[0] == pytest.approx(by_integral, abs=1e-9)


def brute_force_pairs(curve):
    """The definition, pair by pair."""
    found = set()
    for i in range(len(curve)):
        for j in range(i):
            same = curve.mesh.component[i] == curve.mesh.component[j]
            size = curve.mesh.component_sizes[curve.mesh.component[i]]
            if same and min(i - j, size - (i - j)) < 4:
                continue
            distance = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j])
            if distance**2 < 2.25 * (curve.edge_lengths[i] + curve.edge_lengths[j]) ** 2:
                found.add((i, j))
    return found


@given(seed=st.integers(0, 999), spread=st.floats(0, 3))
@settings(max_examples=25, deadline=None)
def test_near_pairs_are_complete(seed, spread):
    rng = np.random.default_rng(seed)
    steps = rng.normal(size=(40, 3)) * 10.0 ** rng.uniform(-spread, 0, size=(40, 1))
    curve = Curve.from_components([np.cumsum(steps[:25], axis=0), np.cumsum(steps[25:], axis=0)])
    i, j = near_pairs(curve)
    listed = [(max(pair), min(pair)) for pair in zip(i.tolist(), j.tolist(), strict=True)]
    assert len(listed) == len(set(listed))
    assert set(listed) == brute_force_pairs(curve)
    assert np.all(curve.edge_lengths[i] <= curve.edge_lengths[j])


@pytest.mark.parametrize("curve", [lattice_knot("4_1"), knot("thistlethwaite")], ids=["lattice", "diagram"])
def test_coarse_knots(curve):
    found = brute_force_pairs(curve)
    assert len(found) > 100
    total, ends = 0.0, curve.vertices[np.stack([curve.mesh.tails, curve.mesh.heads], axis=1)]
    for i, j in found:
        pair = one_pair(*ends[i].tolist(), *ends[j].tolist())
        total += float(cutoff(closeness(pair).value)[0][0] * (exact(pair).value[0] - midpoint(pair).value[0]))
    assert BARRIER.value(curve) == pytest.approx(2 * total, rel=1e-10)
    plain, objective = MoebiusEnergy(), Objective()
    v = np.random.default_rng(8).normal(size=curve.vertices.shape)
    assert objective.value(curve) == pytest.approx(plain.value(curve) + BARRIER.value(curve), rel=1e-12)
    for whole, parts in (
        (objective.value_and_derivative(curve)[1], [e.value_and_derivative(curve)[1] for e in (plain, BARRIER)]),
        (objective.hessian(curve), [plain.hessian(curve), BARRIER.sparse_hessian(curve)]),
        (objective.hessian_product(curve, v), [e.hessian_product(curve, v) for e in (plain, BARRIER)]),
    ):
        np.testing.assert_allclose(whole, sum(parts), atol=1e-10 * np.abs(parts[0]).max())


def test_it_grows_without_bound_where_strands_meet():
    """Across straight strands the energy grows by 2 · 2π/sin θ · log of the gap's inverse, unlike the midpoint sum."""
    growth = np.diff([Objective().value(crossing(10.0**-k, 40)) for k in range(3, 9)])
    assert np.all(growth > 0)
    e = crossing(1e-8, 40)
    i, j = np.argsort(np.linalg.norm(e.midpoints, axis=1))[:2]
    sine = np.linalg.norm(np.cross(e.edge_vectors[i], e.edge_vectors[j])) / np.prod(e.edge_lengths[[i, j]])
    assert growth[-1] == pytest.approx(4 * np.pi / sine * np.log(10), rel=0.01)
    far, near = (MoebiusEnergy().value(crossing(gap, 40)) for gap in (1e-3, 1e-8))
    assert near == pytest.approx(far, rel=1e-3)
    value, derivative = Objective().value_and_derivative(crossing(0.0, 40))  # which is the most there is
    assert np.isfinite(value)
    assert value > Objective().value(crossing(1e-9, 40))
    assert np.isfinite(derivative).all()


def test_the_cutoff_joins_with_two_derivatives():
    def with_derivatives(q):
        return [*cutoff(np.array([q])), change(cutoff(stepped(np.array([q]), np.ones(1)))[1])]

    for q, value in ((0.2, 1.0), (1.0, 1.0), (2.25, 0.0), (3.0, 0.0)):
        assert [float(part[0]) for part in with_derivatives(q)] == pytest.approx([value, 0.0, 0.0], abs=1e-150)
    x = (2.25 - 1.7) / 1.25
    assert cutoff(np.array([1.7]))[0] == pytest.approx(x**3 * (10 - 15 * x + 6 * x**2))
    slope = taylor_slope(lambda t: cutoff(np.array([1.7 + t]))[0], with_derivatives(1.7))
    assert slope == pytest.approx(3, abs=0.02)


@pytest.mark.parametrize("gap", [1e-4, 1e-6, 1e-8, 1e-9])
def test_the_objective_keeps_its_digits_where_midpoint_energies_are_astronomical(gap):
    """Two coaxial polygons: midpoint energies of some 1/g² would cancel to some 1/g, and leave rounding errors."""
    ring, rng = regular_polygon(40).vertices, np.random.default_rng(3)
    curve = Curve.from_components([ring, ring + [0.0, 0.0, gap] + 0.05 * gap * rng.normal(size=ring.shape)])
    value, derivative = Objective().value_and_derivative(curve)
    # coordinates wrong by 10⁻¹⁶ are a gap wrong by 10⁻¹⁶/g
    moved = curve.with_vertices(curve.vertices + 1e-16 * rng.normal(size=curve.vertices.shape))
    assert Objective().value(moved) == pytest.approx(value, rel=1e-15 / gap)
    v = gap * rng.normal(size=curve.vertices.shape)
    ahead, behind = (Objective().value(curve.with_vertices(curve.vertices + h * v)) for h in (1e-3, -1e-3))
    assert (ahead - behind) / 2e-3 == pytest.approx(float(np.sum(derivative * v)), rel=1e-3)
