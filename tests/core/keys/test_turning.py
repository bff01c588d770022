"""Rotations that lay curves flat, and the planes of drawings."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.keys.placement import DrawingPlane, Turn, barycenter, orthonormal, principal_axes
from shapes import regular_polygon, torus_trefoil

ELLIPSE = regular_polygon(80).vertices * np.array([3.0, 1.0, 1.0]) + np.linspace(0, 0.1, 80)[:, None] ** 2


def rotation(seed):
    matrix, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return matrix * np.linalg.det(matrix)


@pytest.mark.parametrize("seed", range(4))
def test_a_turned_curve_has_the_wanted_axes(seed):
    curve, wanted = Curve(ELLIPSE @ rotation(seed) + 5.0), rotation(seed + 10)
    turn = Turn.onto(curve, wanted)
    turned = Curve(turn.of(curve.vertices))
    assert np.linalg.det(turn.rotation) == pytest.approx(1.0)
    np.testing.assert_allclose(np.abs(principal_axes(turned) @ wanted.T), np.eye(3), atol=1e-9)
    np.testing.assert_allclose(barycenter(turned), barycenter(curve), atol=1e-12)
    homogeneous = np.pad(curve.vertices, ((0, 0), (0, 1)), constant_values=1.0)
    np.testing.assert_allclose((homogeneous @ turn.matrix.T)[:, :3], turned.vertices, atol=1e-12)


def test_a_curve_is_turned_and_never_mirrored():
    """Also where its mirror image has axes much nearer to those that are wanted."""
    for seed in range(40):
        turn = Turn.onto(Curve(ELLIPSE @ rotation(seed)), rotation(seed + 100))
        assert np.linalg.det(turn.rotation) == pytest.approx(1.0)


def test_extents_are_in_order():
    flat = Turn.onto(Curve(ELLIPSE @ rotation(3)), np.eye(3)).of(ELLIPSE @ rotation(3))
    x, y, z = np.ptp(flat, axis=0)
    assert x == pytest.approx(6.0, rel=0.01)
    assert y == pytest.approx(2.0, rel=0.02)
    assert z < 0.02


def test_what_lies_as_wanted_is_not_turned():
    curve = Curve(Turn.onto(Curve(ELLIPSE), np.eye(3)).of(ELLIPSE))
    np.testing.assert_allclose(Turn.onto(curve, np.eye(3)).rotation, np.eye(3), atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_of_all_rotations_it_is_the_least(seed):
    """A half turn about an axis leads to the same axes: none of them is nearer."""
    wanted = np.eye(3)
    found = Turn.onto(Curve(ELLIPSE @ rotation(seed)), wanted).rotation
    for half in ((1, -1, -1), (-1, 1, -1), (-1, -1, 1)):
        assert np.trace(np.diag(half) @ found) <= np.trace(found) + 1e-12


def test_axes_made_orthonormal():
    axes = orthonormal(np.array([[2.0, 0.3, 0.4], [0.0, 1.0, 0.0], [0.1, 0.0, 3.0]]))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[2] @ np.array([0.1, 0.0, 3.0]) == pytest.approx(np.hypot(0.1, 3.0))


def test_level_drawings_keep_their_coordinates():
    curve = regular_polygon(30)
    curve = curve.with_vertices(curve.vertices + np.array([3, 4, 5]))
    plane = DrawingPlane.of(curve)
    assert plane.flattened(curve).vertices == pytest.approx(curve.vertices[:, :2])
    assert plane.raised(np.array([[1.0, 2.0, 3.0]])) == pytest.approx(np.array([[1.0, 2.0, 8.0]]))


@pytest.mark.parametrize("seed", range(4))
def test_there_and_back(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    curve = regular_polygon(30)
    curve = curve.with_vertices(curve.vertices @ q + [1, 2, 3])
    plane = DrawingPlane.of(curve)
    flat = plane.flattened(curve).vertices
    assert plane.raised(np.column_stack([flat, np.zeros(30)])) == pytest.approx(curve.vertices)
    assert plane.axes @ plane.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(plane.axes) == pytest.approx(1)
    assert plane.axes[2][abs(plane.axes[2]).argmax()] > 0


def test_what_is_not_flat_is_refused():
    with pytest.raises(CurveError, match="not flat"):
        DrawingPlane.of(torus_trefoil(40))
