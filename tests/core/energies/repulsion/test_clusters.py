"""Clusters: their moments, the exactness of the lists, and how far clusters are from their simplices."""

import numpy as np
import pytest
from mobius_flow.core.energies.edge_pairs import change, stepped
from mobius_flow.core.energies.repulsion.repulsion import THETA, Schedule
from mobius_flow.core.energies.repulsion.simplices import Clusters
from repulsion_references import repulsion, soup, sphere, wavy
from taylor import taylor_slope


def wires(seed, count):
    """Segments all over the surroundings of the unit ball."""
    rng = np.random.default_rng(seed)
    places = rng.normal(size=(count, 1, 3))
    places *= 1.5 / np.linalg.norm(places, axis=2, keepdims=True)
    return soup(places + 0.1 * rng.normal(size=(count, 2, 3)))


ROOT = np.array([0])
OBSTACLES = {"sphere": sphere(4), "wires": wires(2, 900)}
OBSTACLE = pytest.mark.parametrize("obstacle", OBSTACLES.values(), ids=OBSTACLES)


@OBSTACLE
def test_clusters_are_ranges_within_balls_with_moments(obstacle):
    """Moments of degree two are exact by the midpoints of sides (Simpson's rule for segments)."""
    clusters = repulsion(obstacle).clusters
    corners, sizes, tree = clusters.simplices.corners, clusters.simplices.sizes, clusters.tree
    assert np.array_equal(np.sort(tree.start[tree.leaves()]), np.arange(len(obstacle.faces)))
    given = {tuple(each) for each in np.sort(obstacle.corners.reshape(len(obstacle.faces), -1), axis=1)}
    held = corners.transpose(2, 0, 1).reshape(len(obstacle.faces), -1)
    assert given == {tuple(each) for each in np.sort(held, axis=1)}
    if len(corners) == 3:
        points, weights = 0.5 * (corners + np.roll(corners, 1, axis=0)), np.full(3, 1 / 3)
    else:
        points, weights = np.array([corners[0], corners.mean(axis=0), corners[1]]), np.array([1, 4, 1]) / 6
    mass = weights[:, None] * sizes
    for index in (0, 1, 2, 10, 100, 1000):
        members = slice(tree.start[index], tree.stop[index])
        whole, own, at = sizes[members].sum(), mass[:, members], points[:, :, members]
        assert clusters.size[index] == pytest.approx(whole)
        np.testing.assert_allclose(clusters.center[:, index], np.einsum("qf,qif->i", own, at) / whole, atol=1e-13)
        away = at - clusters.center[:, index, None]
        moments = np.einsum("qf,qif,qjf->ij", own, away, away)
        np.testing.assert_allclose(clusters.spread[:, :, index], moments, atol=1e-11)
        radii = np.linalg.norm(corners[:, :, members] - clusters.center[:, index, None], axis=1)
        assert radii.max() == pytest.approx(clusters.radius[index], rel=1e-12)


@OBSTACLE
@pytest.mark.parametrize("curve", [wavy(50), wavy(50, 0.98), wavy(7, 1.3)], ids=["inside", "near", "long edges"])
def test_every_simplex_is_seen_once(obstacle, curve):
    clusters = repulsion(obstacle).clusters
    schedule = Schedule.of(curve, clusters, THETA)
    total = np.zeros(len(curve))
    for groups, sizes in ((schedule.single, clusters.simplices.sizes), (schedule.clustered, clusters.size)):
        for _, panels in groups:
            total += np.bincount(panels.edge, panels.width * sizes[panels.source], len(curve))
    np.testing.assert_allclose(total, clusters.size[0], rtol=1e-12)


@OBSTACLE
@pytest.mark.parametrize("radius", [0.3, 0.7, 0.95])
def test_error_of_clusters(obstacle, radius):
    curve = wavy(60, radius)
    exact, derivative = repulsion(obstacle).value_and_derivative(curve)
    value, found = repulsion(obstacle, THETA).value_and_derivative(curve)
    assert value == pytest.approx(exact, rel=6e-4)
    assert np.linalg.norm(found - derivative) <= 1e-3 * np.linalg.norm(derivative)


@pytest.mark.parametrize("corners", [3, 2], ids=["triangles", "segments"])
def test_far_clusters(corners):
    """Of a symmetric cluster moments of the fourth order are the first to be missed, and those of the gradient too."""
    half = 0.3 * np.random.default_rng(4).normal(size=(20, 3, 3))
    simplices = np.concatenate([half, -half])[:, :corners]
    clusters = Clusters.of(simplices.transpose(1, 2, 0))
    x = np.array([4.0, -3.0, 5.0])[:, None, None] * 2.0 ** np.arange(4)
    near, _ = clusters.simplices.potential(np.arange(40), np.broadcast_to(x, (3, 40, 4)))
    far, gradient = clusters.potential(ROOT, x)
    errors = np.abs(far[0] / near.sum(axis=0) - 1)
    assert np.all(errors[1:] < errors[:-1] / 14)
    v = np.broadcast_to(np.array([1.0, 2.0, -1.0])[:, None, None], x.shape)
    value_change, gradient_change = map(change, clusters.potential(ROOT, stepped(x, v)))
    np.testing.assert_allclose(np.sum(gradient * v, axis=0), value_change, rtol=1e-12)
    slope = taylor_slope(lambda t: clusters.potential(ROOT, x + t * v)[1], [gradient, gradient_change])
    assert slope == pytest.approx(2, abs=0.02)
