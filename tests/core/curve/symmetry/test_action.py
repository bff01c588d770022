"""Groups as they act on meshes: means over them, second derivatives within them, and meshes that keep orbits."""

import numpy as np
import pytest
from dense_stability import tangent_basis
from descent_contracts import point_on
from mobius_flow.core import Curve
from mobius_flow.core.curve.refine import subdivide
from mobius_flow.core.curve.symmetry import NO_SYMMETRY, symmetries
from mobius_flow.core.descent.hessian import lagrangian_matrix
from mobius_flow.core.descent.second_order import Curvature
from mobius_flow.core.driver.moves.remesh import split_edges
from mobius_flow.core.knots import smooth_knot, torus_knot

RNG = np.random.default_rng(7)


def symmetric(curve):
    mean, symmetry, _ = symmetries(curve).symmetrised(curve, curve.mesh.component_sizes)
    return mean, symmetry


def symmetric_point(curve, **options):
    mean, symmetry = symmetric(curve)
    point = point_on(mean, edge_lengths="auto", mesh="fixed", **options)
    return point.problem.on(mean, symmetry=symmetry)


CURVES = {"D4": lambda: torus_knot(3, 4, 72), "S4": lambda: smooth_knot("4_1"), "Th": lambda: smooth_knot("L6a4")}


@pytest.mark.parametrize("name", CURVES)
def test_means_are_orthogonal_projections_onto_what_is_symmetric(name):
    curve, symmetry = symmetric(CURVES[name]())
    assert symmetry.name == name
    u, v = RNG.normal(size=(2, len(curve), 3))
    mean = symmetry.mean(u)
    np.testing.assert_allclose(symmetry.mean(mean), mean, atol=1e-14)
    assert np.sum(mean * v) == pytest.approx(np.sum(u * symmetry.mean(v)))
    for matrix, image in zip(symmetry.matrices, symmetry.images, strict=True):
        np.testing.assert_allclose(mean[image], mean @ matrix.T, atol=1e-14)
    assert NO_SYMMETRY.mean(u) is u


@pytest.mark.parametrize("name", CURVES)
def test_finer_meshes_keep_orbits_together(name):
    curve, symmetry = symmetric(CURVES[name]())
    pieces = symmetry.most(np.where(np.arange(curve.mesh.edges) == 5, 3, 1), curve.mesh)
    assert 1 < np.count_nonzero(pieces == 3) <= len(symmetry)
    finer = subdivide(curve, pieces)
    again = symmetry.on(finer)
    assert again.error(finer) < 1e-12
    assert all(sorted(image) == list(range(len(finer))) for image in again.images)
    np.testing.assert_array_equal(symmetry.on(curve).images, symmetry.images)


def test_where_an_edge_is_split_all_of_its_orbit_are():
    point = symmetric_point(torus_knot(3, 4, 72))
    curve = Curve(point.placed, point.problem.mesh)
    finer = split_edges(point.problem, curve, np.where(np.arange(72) == 5, 2, 1))
    assert 72 + 4 <= len(finer.curve) <= 72 + 8
    symmetry = finer.problem.constraints.symmetry
    assert symmetry.error(Curve(finer.placed, finer.problem.mesh)) < 1e-12
    assert len(set(symmetry.images[1])) == len(finer.curve)


@pytest.mark.parametrize("solver", ["dense", "hierarchical"])
@pytest.mark.parametrize("method", ["lbfgs", "penalty-lbfgs"])
def test_gradients_and_projections_are_symmetric(method, solver):
    point = symmetric_point(torus_knot(3, 4, 96), method=method, solver=solver)
    symmetry, shape = point.problem.constraints.symmetry, point.vertices.shape
    level = RNG.normal(size=point.residual.shape)
    space = point.tangent_space
    for u in (point.gradient, point.derivative, space.pseudo_inverse(level), space.gradient(RNG.normal(size=shape))[0]):
        np.testing.assert_allclose(symmetry.mean(u), u, atol=1e-12 * np.abs(u).max())
    if method == "lbfgs":
        u = space.project(RNG.normal(size=shape))
        np.testing.assert_allclose(symmetry.mean(u), u, atol=1e-12)
        np.testing.assert_allclose(space.project(u), u, atol=1e-4 if solver == "hierarchical" else 1e-10)


def test_points_are_put_on_their_orbits():
    trefoil = torus_knot(2, 3, 60)
    point = symmetric_point(trefoil.with_vertices(trefoil.vertices + np.array([100.0, 20.0, -7.0])))
    moved = point.problem.at(point.vertices + 0.01 * RNG.normal(size=point.vertices.shape))
    symmetry = point.problem.constraints.symmetry
    assert symmetry.error(point.curve.with_vertices(moved.placed)) < 1e-12
    assert np.abs(moved.vertices - point.vertices).max() > 1e-3


@pytest.mark.parametrize("name", ["D4", "S4"])
def test_second_derivatives_are_those_of_symmetric_displacements(name):
    """On an explicit basis of what is tangent and symmetric: solutions, and numbers of eigenvalues below a shift."""
    point = symmetric_point(CURVES[name]())
    symmetry, shape = point.problem.constraints.symmetry, point.vertices.shape
    tangent = tangent_basis(point.tangent_space.constraints)
    means = symmetry.mean(tangent.reshape(*shape, -1)).reshape(tangent.shape)
    u, sizes, _ = np.linalg.svd(means, full_matrices=False)
    basis = u[:, sizes > 0.5]
    assert basis.shape[1] == pytest.approx(tangent.shape[1] / len(symmetry), abs=4)
    gram = point.tangent_space.apply(basis.reshape(len(point.vertices), -1)).reshape(basis.shape)
    force, shift = RNG.normal(size=shape), 0.3
    reduced = basis.T @ (lagrangian_matrix(point) @ basis + shift * gram)
    expected = (basis @ np.linalg.solve(reduced, basis.T @ force.ravel())).reshape(shape)
    curvature = Curvature(point)
    solved = curvature.shifted(shift).solve(symmetry.mean(force))
    np.testing.assert_allclose(solved, expected, atol=1e-8 * np.abs(expected).max())
    values = np.linalg.eigvals(np.linalg.solve(basis.T @ gram, basis.T @ lagrangian_matrix(point) @ basis))
    values = np.sort(values.real[values.real < 0.9])  # of directions that break it, all are 1
    for k in np.argsort(np.diff(values))[-2:]:
        assert curvature.shifted(-0.5 * (values[k] + values[k + 1])).negative == k + 1
