"""Shapes of curves in time are those that Blender shows."""

import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, evaluated, fcurves, relax
from mobius_flow.addon.curves.recorded import Recorded
from shapes import torus_trefoil


def animated(obj):
    return fcurves(obj.data.shape_keys or obj.data)


def bend(curves):
    for curve in curves:
        for point in curve.keyframe_points:
            point.interpolation = "BEZIER"
        curve.update()


def move_keys(curves):
    for curve in curves:
        for point in curve.keyframe_points:
            point.co[0] = 3 * point.co[0] + 0.25
        curve.update()


@pytest.mark.parametrize("changed", [lambda _: None, move_keys, bend], ids=["as written", "retimed", "eased"])
@pytest.mark.parametrize("keyframes", ["SHAPE_KEYS", "FCURVES"])
def test_they_are_what_is_shown(keyframes, changed):
    obj = add_hopf_link(16)
    relax(max_iterations=5, keyframes=keyframes, vertices=40)
    changed(animated(obj))
    recorded = Recorded.of(obj)
    assert recorded.mesh.component_sizes == tuple(len(spline.points) for spline in obj.data.splines)
    for frame, points in zip(recorded.frames, recorded.points, strict=True):
        np.testing.assert_allclose(points, evaluated(obj, frame), atol=2e-6)


def test_radii_are_those_of_the_keys():
    obj = add_trefoil(60)
    relax(max_iterations=8, fit_bevel=True)
    recorded = Recorded.of(obj)
    expected = [block.data[5].radius for block in obj.data.shape_keys.key_blocks]
    np.testing.assert_allclose(recorded.radii[:, 5], expected, rtol=1e-6)


def test_a_curve_without_keys_has_one_shape():
    obj = add_trefoil(30)
    obj.data.splines[0].points[3].radius = 2.0
    recorded = Recorded.of(obj)
    assert recorded.frames.shape == (1,)
    np.testing.assert_allclose(recorded.points[0], evaluated(obj), atol=1e-6)
    assert recorded.radii[0, 3] == 2.0


def test_smooth_splines_are_seen_as_drawn():
    obj = add_curve([torus_trefoil(12).vertices], kind="NURBS")
    recorded = Recorded.of(obj)
    np.testing.assert_allclose(recorded.points[0], evaluated(obj), atol=1e-6)
