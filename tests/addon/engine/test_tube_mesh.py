"""Tubes as meshes: closed surfaces of the right thickness that move without pinching."""

import numpy as np
import pytest
from mobius_flow.addon.engine.tube_mesh import caps, quads, rings
from mobius_flow.core import Curve
from mobius_flow.core.curve import Mesh
from shapes import hopf_link, lattice_knot, regular_polygon, torus_trefoil


def to_edges(points, curve):
    """Distance from points to the nearest edge."""
    a, e = curve.vertices, curve.edge_vectors
    t = (np.einsum("pni,ni->pn", points[:, None] - a, e) / curve.edge_lengths**2).clip(0, 1)
    return np.linalg.norm(points[:, None] - a - t[..., None] * e, axis=-1).min(axis=1)


def volume(vertices, faces):
    """Volume inside a closed surface, positive if its faces are seen counterclockwise from outside."""
    a, b, c, d = (vertices[faces[:, k]] for k in range(4))
    return (np.einsum("ij,ij", a, np.cross(b, c)) + np.einsum("ij,ij", a, np.cross(c, d))) / 6


@pytest.mark.parametrize("sizes", [(5,), (3, 4)])
def test_every_edge_is_between_two_faces_that_run_through_it_opposite_ways(sizes):
    faces = quads(Mesh(sizes), 6)
    assert faces.shape == (6 * sum(sizes), 4)
    edges = [tuple(edge) for k in range(4) for edge in faces[:, [k, (k + 1) % 4]]]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    assert (faces[:, 0] == np.arange(len(faces))).all()  # materials are given to faces by their first vertices


def test_a_round_tube_is_a_torus():
    curve = regular_polygon(400)
    vertices = rings(curve.vertices[None], np.full((1, 400), 0.25), curve.mesh, 200)[0]
    assert volume(vertices, quads(curve.mesh, 200)) == pytest.approx(2 * np.pi**2 * 0.25**2, rel=1e-3)


@pytest.mark.parametrize("curve", [torus_trefoil(120), hopf_link(40), lattice_knot("3_1")], ids=len)
def test_it_is_nowhere_thinner_than_its_radius(curve):
    """At corners it reaches out as far as the cylinders around the edges meet; along edges it is as thick as it is."""
    radius = 0.1
    vertices = rings(curve.vertices[None], np.full((1, len(curve)), radius), curve.mesh, 16)[0]
    distance = to_edges(vertices, curve)
    np.testing.assert_allclose(distance.max(), radius * np.sqrt(2) if len(curve) < 40 else radius, rtol=0.05)
    ring = vertices.reshape(len(curve), 16, 3)
    for end in (ring, ring[curve.mesh.heads]):  # seen along an edge, the rings at both its ends are circles
        chord = end - curve.vertices[curve.mesh.tails][:, None]
        along = np.einsum("nsi,ni->ns", chord, curve.edge_vectors) / curve.edge_lengths[:, None]
        square = np.einsum("nsi,nsi->ns", chord, chord) - along**2
        np.testing.assert_allclose(np.sqrt(square), radius, rtol=1e-6)


def test_radii_are_those_given():
    curve = regular_polygon(50)
    radii = np.linspace(0.1, 0.2, 50)[None] * np.array([[1.0], [2.0]])
    shapes = rings(np.stack([curve.vertices] * 2), radii, curve.mesh, 8).reshape(2, 50, 8, 3)
    distance = np.linalg.norm(shapes - curve.vertices[None, :, None], axis=-1)
    np.testing.assert_allclose(distance.min(axis=-1), radii, rtol=1e-2)


def test_halfway_between_keys_it_does_not_pinch():
    """Blender moves the vertices straight from key to key."""
    start, end = torus_trefoil(200).vertices, torus_trefoil(200).vertices * np.array([1.0, 1.0, 0.8])
    points = np.stack([start, end])
    shapes = rings(points, np.full((2, 200), 0.2), Mesh((200,)), 12)
    middle = shapes.mean(axis=0).reshape(200, 12, 3)
    thickness = np.linalg.norm(middle - points.mean(axis=0)[:, None], axis=-1)
    assert thickness.min() > 0.19


def test_the_tube_of_an_arc_ends_and_caps_close_it():
    mesh = Mesh((3, 4, 2), (False, True, False))
    faces = [*quads(mesh, 5), *caps(mesh, 5)]
    assert len(faces) == 5 * 7 + 4
    edges = [(int(a), int(b)) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)


def test_a_straight_tube_is_a_cylinder():
    curve = Curve(np.linspace(0, 1, 5)[:, None] * np.array([0.0, 0.0, 3.0]), Mesh((5,), (False,)))
    vertices = rings(curve.vertices[None], np.full((1, 5), 0.25), curve.mesh, 200)[0]
    np.testing.assert_allclose(np.linalg.norm(vertices[:, :2], axis=1), 0.25, rtol=1e-12)
    start, end = (vertices[face] for face in caps(curve.mesh, 200))
    for cap, height, up in ((start, 0.0, -1.0), (end, 3.0, 1.0)):
        np.testing.assert_allclose(cap[:, 2], height, atol=1e-15)
        assert np.cross(cap[1] - cap[0], cap[2] - cap[1])[2] * up > 0  # seen counterclockwise from outside
