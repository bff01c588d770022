"""Markers follow a polygon through changes of its mesh: always as many, every vertex among them, all on edges."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.addon.engine.markers import Markers


def changes(rng, closed, count=12):
    """A polygon on one mesh after the other: vertices are put on edges, taken away from them, and numbered anew."""
    corners = rng.normal(size=(6, 3))
    corner = np.arange(6.0)  # how far along each vertex is, corners at whole numbers
    span = 6.0 if closed else 5.0
    at = corner
    for _ in range(count):
        extra = rng.uniform(0.0, span, rng.integers(1, 9))
        old = np.setdiff1d(at, corner)
        at = np.unique(np.concatenate([corner, rng.permutation(old)[: rng.integers(0, 4)], extra]))
        shift = rng.integers(len(at)) if closed else 0
        yield np.roll(at, -shift), corners


def points(at, corners, closed):
    """Places on the polygon of corners, as points of space."""
    tails = np.minimum(np.floor(at), len(corners) - 1 - (not closed)).astype(int)
    share = (at - tails)[:, None]
    return (1 - share) * corners[tails] + share * corners[(tails + 1) % len(corners)]


def distance_from(polygon, point):
    """Of a point from the closed polygon."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    t = np.clip(np.einsum("ij,ij->i", point - a, b - a) / np.square(b - a).sum(axis=1), 0, 1)
    return np.linalg.norm(a + t[:, None] * (b - a) - point, axis=1).min()


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("closed", [True, False])
def test_every_vertex_is_a_marker_and_every_marker_on_the_polygon(closed, seed):
    meshes = list(changes(np.random.default_rng(seed), closed))
    at, corners = meshes[0]
    markers = Markers(len(at), closed)
    for (old, _), (new, _) in pairwise(meshes):
        here = np.flatnonzero(np.isin(old, new))
        there = [int(np.flatnonzero(new == place)[0]) for place in old[here]]
        markers.change(here.tolist(), there, len(new))
    for stage, (at, _) in enumerate(meshes):
        polygon = points(at, corners, closed)
        shown = markers.on(polygon, stage)
        assert len(shown) == len(markers) >= max(len(each) for each, _ in meshes)
        assert {tuple(vertex) for vertex in polygon} <= {tuple(marker) for marker in shown}
        assert max(distance_from(polygon, marker) for marker in shown) < 1e-12
        length = np.linalg.norm(np.diff(shown, axis=0), axis=1).sum()  # they follow each other along it, once
        length += np.linalg.norm(shown[0] - shown[-1]) if closed else 0.0
        whole = np.linalg.norm(np.diff(points(np.arange(6.0), corners, closed), axis=0), axis=1).sum()
        assert length == pytest.approx(whole + (np.linalg.norm(corners[0] - corners[5]) if closed else 0.0))
    start, _ = meshes[0]
    np.testing.assert_array_equal(
        markers.on(points(start, corners, closed), 0)[0], points(start[:1], corners, closed)[0]
    )


def test_markers_of_an_edge_become_its_new_vertices():
    """As long as there are any; then all shapes before get one more."""
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    markers = Markers(4, closed=True)
    markers.change([0, 1, 2, 3], [0, 2, 3, 4], 5)
    assert len(markers) == 5
    markers.change([0, 2, 3, 4], [0, 1, 2, 3], 4)
    markers.change([0, 1, 2, 3], [0, 2, 3, 4], 5)
    assert len(markers) == 5
    np.testing.assert_array_equal(markers.on(square, 0), np.insert(square, 1, [0.5, 0, 0], axis=0))
    markers.change([0, 1, 2, 3, 4], [0, 1, 2, 4, 5], 6)
    assert len(markers) == 6
