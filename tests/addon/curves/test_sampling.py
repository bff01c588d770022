"""Bézier and NURBS splines become the polygons that are drawn for them, at any preview resolution."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, contents, relax, stored, values
from mobius_flow.addon.curves import splines
from shapes import hopf_link

SAMPLED = {"sample_splines": True, "max_iterations": 0, "keyframes": "RESULT"}


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


@pytest.mark.parametrize("resolution", [1, 2, 3, 12])
@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_the_polygon_is_the_one_drawn(kind, resolution):
    obj = smooth_link(kind, resolution)
    drawn = splines.sampled(obj)
    assert [len(loop) for loop in drawn] == 2 * [6 * resolution]
    relax(**SAMPLED, vertices=12 * resolution if resolution > 2 else 0)
    points = stored(obj.data)
    assert [spline.type for spline in obj.data.splines] == ["POLY", "POLY"]
    assert all(spline.use_cyclic_u for spline in obj.data.splines)
    nearest = np.linalg.norm(points[:, None] - np.concatenate(drawn)[None], axis=2).min(axis=0)
    assert nearest.max() < 1e-6, "every point drawn is a point now"


@pytest.mark.parametrize("resolution", [1, 2, 12])
def test_values_of_control_points_are_spread(resolution):
    obj = smooth_link("BEZIER", resolution)
    radii = np.linspace(0.5, 1.5, 6)
    for name in ("Red", "Blue"):
        obj.data.materials.append(bpy.data.materials.new(name))
    for spline in obj.data.splines:
        spline.bezier_points.foreach_set("radius", radii.astype(np.float32))
        spline.material_index = 1
    relax(**SAMPLED, vertices=12 * resolution if resolution > 2 else 0)
    for spline in obj.data.splines:
        found = values(spline, "radius")
        assert found.min() == 0.5
        assert found.max() == pytest.approx(1.5)
        assert spline.material_index == 1
        if resolution == 12:
            np.testing.assert_allclose(found[::12], radii, atol=1e-6)


def test_smooth_and_straight_splines_keep_their_order():
    obj = smooth_link("BEZIER", 2)
    polygon = obj.data.splines.new("POLY")
    polygon.points.add(3)
    square = np.array([[9, 0, 0, 1], [10, 0, 0, 1], [10, 1, 0, 1], [9, 1, 0, 1]], dtype=np.float32)
    polygon.points.foreach_set("co", square.ravel())
    polygon.use_cyclic_u = True
    relax(**SAMPLED)
    last = stored(obj.data)[-len(obj.data.splines[2].points) :]
    assert np.abs(last[:, :3] - square[0, :3]).max() <= 1


def test_a_segment_is_no_polygon():
    obj = smooth_link("BEZIER", 12)
    vertices = 2 * hopf_link(6).vertices + 9
    spline = obj.data.splines.new("BEZIER")
    spline.bezier_points.add(1)
    spline.bezier_points.foreach_set("co", vertices[:2].ravel())
    spline.use_cyclic_u, spline.resolution_u = True, 1
    before = contents()
    with pytest.raises(RuntimeError, match="Spline 3 of 'Knot' is drawn with only 2 points; raise its Resolution U"):
        relax(**SAMPLED)
    assert contents() == before


def test_the_questions_count_points():
    question = "'Knot' has 2 Bézier splines; they become polygons of 60 points in all"
    assert splines.questions([smooth_link("BEZIER", 5)]) == [question]


def test_of_many_objects_some_are_asked_about():
    objects = [smooth_link("NURBS", 3) for _ in range(8)] + [add_curve([hopf_link(6).vertices[:6]])]
    assert len(splines.questions(objects[5:])) == 3
    lines = splines.questions(objects)
    assert [line.split("'")[1] for line in lines[:-1]] == [obj.name for obj in objects[:5]]
    assert lines[-1] == "3 more objects have smooth splines too"
