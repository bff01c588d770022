"""Show selects the points that a message is about, whatever kind of spline they are of."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil
from mobius_flow.addon.curves.splines import control_points
from mobius_flow.core.base.errors import Place
from shapes import torus_trefoil

CROSSED = np.array([[0.0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]])
AWAY = np.array([[9.0, 0, 0], [9, 2, 0], [9, 0, 2]])


def fails(operator):
    """The message of a run that is refused by the worker."""
    operator.start()
    assert operator.until(lambda: False) == {"CANCELLED"}
    return operator.run.message


def selected(obj):
    """Numbers of the selected points, spline by spline."""
    bpy.ops.object.mode_set(mode="OBJECT")
    name = {"BEZIER": "select_control_point"}
    return [
        [k for k, point in enumerate(control_points(spline)) if getattr(point, name.get(spline.type, "select"))]
        for spline in obj.data.splines
    ]


def test_a_crossing(operator):
    obj = add_curve([AWAY, CROSSED])
    obj.location, obj.scale = (5, 0, 1), (2, 2, 2)
    for point in obj.data.splines[0].points:
        point.select = True  # which is dropped
    assert not bpy.ops.curve.mobius_flow_show.poll()
    message = fails(operator)
    wanted = "Segment 1 of spline 2 of 'Knot' and segment 3 of spline 2 of 'Knot' touch or cross near (7, 2, 1)"
    assert message.startswith(wanted)
    assert bpy.ops.curve.mobius_flow_show() == {"FINISHED"}
    assert obj.mode == "EDIT"
    assert selected(obj) == [[], [0, 1, 2, 3]]
    (spot,) = operator.run.trouble
    np.testing.assert_allclose(spot.marks, [[1, 1, 0]], atol=0.01)
    obj.data.splines[1].points[1].co[2] = 3
    assert not bpy.ops.curve.mobius_flow_show.poll(), "it was mended"


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_smooth_splines_have_their_nearest_points_selected(operator, kind):
    points = 3 * torus_trefoil(9).vertices
    obj = add_curve([points, points], kind=kind)
    operator.given["sample_splines"] = True
    assert "touch or cross" in fails(operator) or "same point" in operator.run.message
    assert bpy.ops.curve.mobius_flow_show() == {"FINISHED"}
    assert any(selected(obj))


def test_a_hidden_curve(operator):
    obj = add_curve([CROSSED])
    fails(operator)
    obj.hide_set(True)
    bpy.context.view_layer.objects.active = obj
    with pytest.raises(RuntimeError, match="The curve is hidden, or not in this view layer; make it visible first"):
        bpy.ops.curve.mobius_flow_show()


def test_a_stalled_run_shows_where_it_got_stuck(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(2)
    assert not bpy.ops.curve.mobius_flow_show.poll()
    session = operator.run.session

    def stalled(outcome):
        session.outcome = replace(outcome, place=Place((3, 4), tuple(operator.run.last.curve.vertices[3])))

    session.end = stalled
    assert operator.until(lambda: False) == {"FINISHED"}
    assert bpy.ops.curve.mobius_flow_show() == {"FINISHED"}
    assert selected(obj) == [[3, 4]]
