"""Tubes as meshes: closed surfaces of the right thickness that neither pinch, jump nor twist more than they must."""

from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision.gap import thickness
from mobius_flow.core.curve.tube import caps, carried, normals, quads, rings, signed_angle, tangents, tubes
from mobius_flow.core.knots import knot
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


@pytest.mark.parametrize("mesh", [Mesh((5,)), Mesh((3, 4)), Mesh((3, 4, 2), (False, True, False))])
def test_every_edge_is_between_two_faces_that_run_through_it_opposite_ways(mesh):
    """Tubes of arcs end, and caps close them."""
    faces, ends = quads(mesh, 6), caps(mesh, 6)
    assert (faces.shape, ends.shape) == ((6 * mesh.edges, 4), (2 * len(mesh.ends), 6))
    edges = [(int(a), int(b)) for face in [*faces, *ends] for a, b in zip(face, np.roll(face, -1), strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    if mesh.all_closed:
        assert (faces[:, 0] == np.arange(len(faces))).all()  # materials are given to faces by their first vertices


def test_a_round_tube_is_a_torus_and_a_straight_one_a_cylinder():
    curve = regular_polygon(400)
    vertices = rings(curve.vertices[None], np.full((1, 400), 0.25), curve.mesh, 200)[0]
    assert volume(vertices, quads(curve.mesh, 200)) == pytest.approx(2 * np.pi**2 * 0.25**2, rel=1e-3)
    curve = Curve(np.linspace(0, 1, 5)[:, None] * np.array([0.0, 0.0, 3.0]), Mesh((5,), (False,)))
    vertices = rings(curve.vertices[None], np.full((1, 5), 0.25), curve.mesh, 200)[0]
    np.testing.assert_allclose(np.linalg.norm(vertices[:, :2], axis=1), 0.25, rtol=1e-12)
    start, end = (vertices[face] for face in caps(curve.mesh, 200))
    for cap, height, up in ((start, 0.0, -1.0), (end, 3.0, 1.0)):
        np.testing.assert_allclose(cap[:, 2], height, atol=1e-15)
        assert np.cross(cap[1] - cap[0], cap[2] - cap[1])[2] * up > 0  # seen counterclockwise from outside


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


def self_linking(points, normal):
    """Gauss's linking number of a curve and the curve beside it, by the solid angles of pairs of edges."""
    beside = points + 1e-2 * normal
    a = points[:, None] - beside[None]
    b = np.roll(points, -1, axis=0)[:, None] - beside[None]
    c = np.roll(points, -1, axis=0)[:, None] - np.roll(beside, -1, axis=0)[None]
    d = points[:, None] - np.roll(beside, -1, axis=0)[None]
    return sum(solid_angle(*corners).sum() for corners in ((a, b, c), (c, d, a))) / (4 * np.pi)


def solid_angle(a, b, c):
    """Oriented solid angles of triangles (van Oosterom and Strackee)."""
    la, lb, lc = (np.linalg.norm(x, axis=-1) for x in (a, b, c))
    dot = lambda x, y: np.einsum("...i,...i", x, y)  # noqa: E731
    numerator = dot(a, np.cross(b, c))
    return 2 * np.arctan2(numerator, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)


def writhing(n=240, keys=17):
    """A figure eight whose crossing opens: its writhe falls by more than a half."""
    t = 2 * np.pi * np.arange(n) / n
    eight = np.stack([np.sin(t), np.sin(2 * t), 0.3 * np.cos(t)], axis=1)
    circle = np.stack([np.sin(t), -np.cos(t), 0.0 * t], axis=1)
    share = np.linspace(0, 1, keys)[:, None, None]
    return (1 - share) * eight + share * circle


def closing_twist(points, normal):
    """The angle by which each normal is turned against the one carried from the vertex before."""
    tau = tangents(points)
    moved = carried(normal, tau, np.roll(tau, -1, axis=0))
    return signed_angle(moved, np.roll(normal, -1, axis=0), np.roll(tau, -1, axis=0))


def test_the_self_linking_number_stays():
    """While most of a turn of writhe is lost: the twist makes up for it, and nothing jumps."""
    points = writhing()
    u = normals(points)
    linking = [self_linking(p, n) for p, n in zip(points, u, strict=True)]
    np.testing.assert_allclose(linking, round(linking[0]), atol=1e-6)
    twists = [closing_twist(p, n).sum() for p, n in zip(points, u, strict=True)]
    assert abs(twists[0] - twists[-1]) > np.pi
    assert abs(twists[-1]) <= np.pi + 1e-9


def test_normals_turn_no_more_from_key_to_key_than_the_curve():
    points = writhing(keys=33)
    u, tau = normals(points), tangents(points)
    turns = np.linalg.norm(np.diff(tau, axis=0), axis=-1).max(axis=1)
    assert (np.linalg.norm(np.diff(u, axis=0), axis=-1).max(axis=1) < 4 * turns + 1e-9).all()


def test_at_rest_normals_stay_and_a_rigid_motion_turns_them():
    points = np.repeat(torus_trefoil(60).vertices[None], 3, axis=0)
    u = normals(points)
    np.testing.assert_allclose(u[0], u[2], atol=1e-12)
    points = torus_trefoil(60).vertices
    angle = 0.3
    rotation = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    u = normals(np.stack([points @ rotation.T, points]))
    back = u[0] @ rotation
    assert np.abs(signed_angle(back, u[1], tangents(points))).max() < 0.2


def helix(n=80, turns=2.0):
    t = np.linspace(0, 2 * np.pi * turns, n)
    return np.stack([np.cos(t), np.sin(t), 0.2 * t], axis=1)


def test_along_an_arc_nothing_twists():
    """Each normal is carried to the next by the least rotation, at every key."""
    points = np.stack([helix(), helix(turns=1.0)])
    u, tau = normals(points, closed=False), tangents(points, closed=False)
    np.testing.assert_allclose(np.einsum("kni,kni->kn", u, tau), 0, atol=1e-12)
    np.testing.assert_allclose(carried(u[:, :-1], tau[:, :-1], tau[:, 1:]), u[:, 1:], atol=1e-12)
    u = normals(points[:1] + np.arange(3.0)[:, None, None], closed=False)  # where it only moves they stay
    np.testing.assert_allclose(u, np.broadcast_to(u[2], u.shape), atol=1e-12)
    tau = tau[0]  # which begin along the first edge and end along the last
    for edge, tangent in ((points[0, 1] - points[0, 0], tau[0]), (points[0, -1] - points[0, -2], tau[-1])):
        np.testing.assert_allclose(tangent, edge / np.linalg.norm(edge), atol=1e-15)
    np.testing.assert_allclose(tau[1:-1], tangents(points[0])[1:-1], atol=1e-15)


ARC = Curve([[0.0, 0, 0], [1, 0, 0], [2, 1, 0], [2, 2, 1]], Mesh((4,), (False,)))


@pytest.mark.parametrize("curve", [knot("3_1"), knot("L6a4"), ARC], ids=["knot", "link", "arc"])
def test_tubes_are_closed_and_have_their_radius(curve):
    trimesh = pytest.importorskip("trimesh")
    radius = 0.2 * thickness(curve)
    for (tube,), points, closed in zip(tubes([curve], radius, 24), curve.components, curve.mesh.closed, strict=True):
        mesh = trimesh.Trimesh(tube.points, tube.faces, process=False)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        edges = np.roll(points, -1, axis=0) - points if closed else np.diff(points, axis=0)
        prism = 0.5 * 24 * np.sin(2 * np.pi / 24) * radius**2  # mitres take as much as they give, twist hardly any
        assert mesh.volume == pytest.approx(prism * np.linalg.norm(edges, axis=1).sum(), rel=1e-2)
        assert np.linalg.norm(tube.normals, axis=1) == pytest.approx(1.0)


def test_surfaces_of_a_motion_do_not_jump():
    """Where the twist that closes a frame has grown beyond half a turn, its own least one would be another."""
    curves = [Curve(points) for points in writhing(keys=65)]

    def furthest(frames):
        return max(np.linalg.norm(b.normals - a.normals, axis=1).max() for a, b in pairwise(frames))

    assert furthest(tubes(curves, 0.05)[0]) < 0.6
    assert furthest(tubes([each], 0.05)[0][0] for each in curves) > 1.9
