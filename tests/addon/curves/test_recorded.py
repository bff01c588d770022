"""Shapes of curves, at rest and in time, are those that Blender shows; smooth splines become the polygons drawn."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, evaluated, fcurves, relax, stored, values
from families import crossed
from mobius_flow.addon.curves import splines
from mobius_flow.addon.curves.recorded import Recorded
from shapes import hopf_link

SAMPLED = {"sample_splines": True, "max_iterations": 0, "keyframes": "RESULT"}


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
def test_they_are_what_is_shown(changed):
    obj = add_hopf_link(16)
    relax(max_iterations=5, vertices=40)
    changed(fcurves(obj.data.shape_keys))
    recorded = Recorded.of(obj)
    assert recorded.mesh.component_sizes == tuple(len(spline.points) for spline in obj.data.splines)
    for frame, points in zip(recorded.frames, recorded.points, strict=True):
        np.testing.assert_allclose(points, evaluated(obj, frame), atol=2e-6)


# -- smooth splines --------------------------------------------------------------------------------------------------


def smooth_link(kind, resolution):
    """Two linked rings, of six control points each."""
    vertices = 2 * hopf_link(6).vertices
    obj = add_curve([vertices[:6], vertices[6:]], kind=kind)
    for spline in obj.data.splines:
        spline.resolution_u = resolution
        if kind == "BEZIER":
            for point in spline.bezier_points:
                point.handle_left_type = point.handle_right_type = "AUTO"
    bpy.context.view_layer.update()
    return obj


@pytest.mark.parametrize(("kind", "resolution"), crossed(["BEZIER", "NURBS"], [1, 12, 2, 3]))
def test_the_polygon_is_the_one_drawn_with_values_between_those_of_control_points(kind, resolution):
    obj = smooth_link(kind, resolution)
    for name in ("Red", "Blue"):
        obj.data.materials.append(bpy.data.materials.new(name))
    radii = np.linspace(0.5, 1.5, 6)
    for spline in obj.data.splines:
        splines.control_points(spline).foreach_set("radius", radii.astype(np.float32))
        spline.material_index = 1
    drawn = splines.sampled(obj)
    assert [len(loop) for loop in drawn] == 2 * [6 * resolution]
    relax(**SAMPLED, vertices=12 * resolution if resolution > 2 else 0)
    points = stored(obj.data)
    nearest = np.linalg.norm(points[:, None] - np.concatenate(drawn)[None], axis=2).min(axis=0)
    assert nearest.max() < 1e-6, "every point drawn is a point now"
    for spline in obj.data.splines:
        assert (spline.type, spline.use_cyclic_u, spline.material_index) == ("POLY", True, 1)
        found = values(spline, "radius")
        assert (found.min(), found.max()) == (0.5, pytest.approx(1.5))
        if resolution == 12:
            np.testing.assert_allclose(found[::12], radii, atol=1e-6)


def test_the_questions_count_points_and_of_many_objects_some_are_asked_about():
    question = "Bézier splines of 'Knot' become polygons, of 60 points in all"
    assert splines.questions([smooth_link("BEZIER", 5)]) == [question]
    objects = [smooth_link("NURBS", 3) for _ in range(8)] + [add_curve([hopf_link(6).vertices[:6]])]
    assert len(splines.questions(objects[5:])) == 3
    lines = splines.questions(objects)
    assert [line.split("'")[1] for line in lines[:-1]] == [obj.name for obj in objects[:5]]
    assert lines[-1] == "3 more objects have smooth splines too"
