"""Normals along closed curves in motion: perpendicular, closing, twisting little, and without jumps."""

import numpy as np
import pytest
from mobius_flow.addon.engine.ribbon import carried, normals, signed_angle, tangents, turned
from shapes import regular_polygon, torus_trefoil


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


def test_they_are_unit_normals():
    points = writhing()
    u, tau = normals(points), tangents(points)
    np.testing.assert_allclose(np.linalg.norm(u, axis=-1), 1, rtol=1e-12)
    np.testing.assert_allclose(np.einsum("kni,kni->kn", u, tau), 0, atol=1e-12)


@pytest.mark.parametrize("points", [torus_trefoil(200).vertices, writhing()[0]], ids=["trefoil", "eight"])
def test_one_curve_twists_evenly_and_at_most_half_a_turn(points):
    twist = closing_twist(points, normals(points[None])[0])
    lengths = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    np.testing.assert_allclose(twist, twist.sum() * lengths / lengths.sum(), atol=1e-9)
    assert abs(twist.sum()) <= np.pi + 1e-9


def test_a_planar_curve_does_not_twist():
    points = regular_polygon(50).vertices
    np.testing.assert_allclose(closing_twist(points, normals(points[None])[0]), 0, atol=1e-12)


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


def test_a_curve_at_rest_keeps_its_normals():
    points = np.repeat(torus_trefoil(60).vertices[None], 3, axis=0)
    u = normals(points)
    np.testing.assert_allclose(u[0], u[2], atol=1e-12)


def test_turning_about_a_rigid_axis_turns_the_normals_with_it():
    points = torus_trefoil(60).vertices
    angle = 0.3
    rotation = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    u = normals(np.stack([points @ rotation.T, points]))
    back = u[0] @ rotation
    assert np.abs(signed_angle(back, u[1], tangents(points))).max() < 0.2


def test_carrying_keeps_angles():
    rng = np.random.default_rng(5)
    a, b = (x / np.linalg.norm(x, axis=-1, keepdims=True) for x in rng.normal(size=(2, 20, 3)))
    u = np.cross(a, b)
    u /= np.linalg.norm(u, axis=-1, keepdims=True)
    np.testing.assert_allclose(carried(u, a, b), u, atol=1e-12)  # the axis itself
    phi = rng.uniform(-3, 3, 20)
    np.testing.assert_allclose(signed_angle(u, carried(turned(u, a, phi), a, b), b), phi, atol=1e-9)


def helix(n=80, turns=2.0):
    t = np.linspace(0, 2 * np.pi * turns, n)
    return np.stack([np.cos(t), np.sin(t), 0.2 * t], axis=1)


def test_along_an_arc_nothing_twists():
    """Each normal is carried to the next by the least rotation, at every key."""
    points = np.stack([helix(), helix(turns=1.0)])
    u, tau = normals(points, closed=False), tangents(points, closed=False)
    np.testing.assert_allclose(np.einsum("kni,kni->kn", u, tau), 0, atol=1e-12)
    np.testing.assert_allclose(carried(u[:, :-1], tau[:, :-1], tau[:, 1:]), u[:, 1:], atol=1e-12)


def test_an_arc_begins_along_its_first_edge_and_ends_along_its_last():
    points = helix()
    tau = tangents(points, closed=False)
    for edge, tangent in ((points[1] - points[0], tau[0]), (points[-1] - points[-2], tau[-1])):
        np.testing.assert_allclose(tangent, edge / np.linalg.norm(edge), atol=1e-15)
    np.testing.assert_allclose(tau[1:-1], tangents(points)[1:-1], atol=1e-15)


def test_an_arc_that_moves_keeps_its_normals():
    points = np.stack([helix() + shift for shift in (0.0, 1.0, 2.0)])
    u = normals(points, closed=False)
    np.testing.assert_allclose(u, np.broadcast_to(u[2], u.shape), atol=1e-12)
