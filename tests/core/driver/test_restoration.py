"""The way back to the constraints: exact, shortest, and quadratically fast where little is left to correct."""

from dataclasses import replace

import numpy as np
import pytest
from descent_contracts import point_on, with_geometry
from hard_curves import uneven
from mobius_flow.core import Curve, RelaxOptions, minimize
from mobius_flow.core.descent.geometry import Geometry
from mobius_flow.core.solve.constraints import Barycenters, Constraints
from mobius_flow.core.solve.saddle import TangentSpace
from mobius_flow.core.solve.saddle.tangent_space import euclidean_correction
from shapes import chain_of_rings, hopf_link, opened, regular_polygon, straight_arc, torus_trefoil


def rough(curve):
    rng = np.random.default_rng(41)
    return curve.with_vertices(curve.vertices + 0.02 * rng.normal(size=curve.vertices.shape))


SQUARES = Curve.from_components([regular_polygon(4).vertices + shift for shift in (0.0, 9.0, 18.0)])  # cosines of 0
TRIANGLES = Curve.from_components([regular_polygon(3).vertices, regular_polygon(3).vertices + 9.0])
CURVES = {
    "trefoil": (rough(torus_trefoil(60)), None),
    "two parts": (rough(hopf_link(20)), (1, 0)),
    "squares": (SQUARES, (0, 1, 0)),
    "triangles": (rough(TRIANGLES), None),
    "plane": (rough(regular_polygon(30, dimension=2)), None),
    "4-space": (rough(regular_polygon(30, dimension=4)), None),
    "arcs": (
        opened(rough(Curve.from_components([*SQUARES.components, regular_polygon(7).vertices])), 0, 3),
        (0, 1, 0, 1),
    ),
    "straight": (straight_arc(12), None),
    "one edge": (straight_arc(1), None),
}


@pytest.mark.parametrize("name", CURVES)
def test_corrections_solve_the_linearised_constraints_by_the_shortest_way(name):
    """u = −Lᵀ (L Lᵀ)⁻¹ Φ and translations, L the rows of the lengths."""
    curve, parts = CURVES[name]
    n, m = curve.vertices.shape
    constraints = Constraints(curve.edge_lengths, Barycenters.of(curve, parts=parts))
    derivative = constraints.derivative(curve)
    residual = np.random.default_rng(43).normal(size=derivative.count)
    u = euclidean_correction(constraints, curve, residual)
    np.testing.assert_allclose(derivative.apply(u), -residual, atol=1e-11 * np.abs(u).max() / curve.edge_lengths.min())
    shortest = -np.linalg.pinv(derivative.length_rows().toarray()) @ residual[: curve.mesh.edges]
    part = np.asarray(parts or [0] * len(curve.mesh.component_sizes))[curve.mesh.component]
    for k in range(max(part) + 1):
        translation = (u - shortest.reshape(n, m))[part == k]
        np.testing.assert_allclose(translation, translation[:1].repeat(len(translation), axis=0), atol=1e-9)


def test_short_steps_do_not_drift_away_from_the_lengths():
    """A step that misses them by less than the tolerance is led back like any other."""
    base = point_on(rough(torus_trefoil(60)))
    move = 5e-6 * base.gradient / base.gradient_norm
    missed = base.problem.at(base.vertices - move).infeasibility
    end = base.retract(base.vertices - move, base.residual)
    assert 100 * end.infeasibility < missed < Geometry().tolerance


class Counting(TangentSpace):
    """A tangent space that counts its solves."""

    def __init__(self, space):
        super().__init__(space, space.constraints, None)
        self._space, self.solves = space, 0

    def solve(self, eta, xi):
        self.solves += 1
        return self._space.solve(eta, xi)


@pytest.mark.parametrize(("size", "solves"), [(0.001, 0), (0.01, 1), (0.03, 3)])
def test_the_metric_is_asked_only_for_large_corrections(size, solves):
    point = point_on(torus_trefoil(60))
    direction = point.tangent_space.project(np.random.default_rng(47).normal(size=point.vertices.shape))
    direction *= size / np.abs(direction).max()
    moved = point.problem.at(point.vertices + direction).residual
    assert (np.abs(moved - point.residual).max() > Geometry().small) == (solves > 0)
    space = Counting(point.tangent_space)
    end = point.retract(point.vertices + direction, point.residual, space)
    assert np.abs(end.residual).max() <= Geometry().tolerance
    assert space.solves == solves


def test_the_last_corrections_converge_quadratically():
    """From below 10⁻³ two of them do; at the rate of (42) they take more."""
    point = point_on(torus_trefoil(60))
    direction = point.tangent_space.project(np.random.default_rng(53).normal(size=point.vertices.shape))
    direction *= 0.003 / np.abs(direction).max()
    aimed = point.vertices + direction
    assert 1e-4 < np.abs(point.problem.at(aimed).residual).max() < Geometry().small
    few = Geometry(max_iterations=3)
    assert with_geometry(point, few).retract(aimed, point.residual) is not None
    assert with_geometry(point, replace(few, small=1e-300)).retract(aimed, point.residual) is None


def test_edges_much_shorter_than_others_are_left_to_the_metric():
    """The shortest corrections would turn them by a thousand times the residual."""
    point = point_on(uneven(torus_trefoil(60), 1000.0, seed=5))
    aimed = point.vertices - 1e-3 / np.abs(point.gradient).max() * point.gradient
    residual = point.problem.at(aimed).residual - point.residual
    assert np.abs(residual).max() < Geometry().small
    space = Counting(point.tangent_space)
    end = point.retract(aimed, point.residual, space)
    assert end is not None
    assert space.solves > 0
    tau, before = (p.curve.edge_vectors / p.curve.edge_lengths[:, None] for p in (end, point.problem.at(aimed)))
    assert np.linalg.norm(tau - before, axis=1).max() < 10.0 * Geometry().small


def test_a_polygon_within_a_line_is_given_up():
    """There one edge cannot become longer than the others, which take it back to where it began."""
    point = point_on(torus_trefoil(60))
    flat = np.zeros_like(point.vertices)
    flat[:, 0] = 0.1 * np.minimum(np.arange(60), 60 - np.arange(60))
    level = point.problem.at(flat).residual
    level[3] += 1e-4
    assert point.retract(flat, level) is None


def test_long_chains_are_led_back_although_sums_along_them_are_rounded():
    """Σ ℓ_I m_I is some 10⁶ on this chain; with a tolerance of 10⁻¹¹ for it the energy went down by 0.2."""
    curve = chain_of_rings(400, (4,))
    options = RelaxOptions(max_iterations=1, solver="hierarchical", vertices=len(curve), mesh="fixed")
    start, end = minimize(curve, options).energies
    assert end < start - 20.0
