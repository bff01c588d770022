"""The plane that a drawing lies in."""

import numpy as np
import pytest
from mobius_flow.addon.engine.drawing_plane import DrawingPlane
from mobius_flow.core import CurveError
from shapes import regular_polygon, torus_trefoil


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
