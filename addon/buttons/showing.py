"""The button that shows where something is the matter."""

import bpy
import numpy as np

from ..curves.splines import control_points
from ..engine.placement import Spot, at
from ..live import registry
from ..live.run import Run
from ..translations import rpt_, tip_


class CURVE_OT_mobius_flow_show(bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Select the points that the message is about, in Edit Mode"""

    bl_idname = "curve.mobius_flow_show"
    bl_label = "Show"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is something to show."""
        cls.poll_message_set(tip_("Nothing is the matter at any place of this curve"))
        run = registry.shown(context.active_object)
        return run is not None and run.state.over and bool(run.trouble)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select the points, and look at them if there is a view."""
        run = registry.shown(context.active_object)
        assert run is not None, "poll looks for it"
        spots = _spots(run)
        if not spots:
            sentence = "The curve is hidden, or not in this view layer; make it visible first"
            self.report({"ERROR"}, rpt_(sentence))
            return {"CANCELLED"}
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for obj in context.view_layer.objects:
            obj.select_set(obj in spots)
        context.view_layer.objects.active = next(iter(spots))
        for obj, spot in spots.items():
            _select(obj.data, spot)
        bpy.ops.object.mode_set(mode="EDIT")
        if context.region_data is not None:
            bpy.ops.view3d.view_selected()
        return {"FINISHED"}


def _spots(run: Run) -> dict[bpy.types.Object, Spot]:
    """The spots on objects that can be edited here."""
    return {obj: spot for obj, spot in run.spots.items() if obj.visible_get()}


def _select(data: bpy.types.Curve, spot: Spot) -> None:
    """Select the nearest points of a curve, and no others."""
    points = [point for spline in data.splines for point in control_points(spline)]
    chosen = at(np.array([point.co[:3] for point in points]), spot.points)
    for point, wanted in zip(points, chosen.tolist(), strict=True):
        if isinstance(point, bpy.types.BezierSplinePoint):
            point.select_control_point = wanted
            point.select_left_handle = point.select_right_handle = False
        else:
            point.select = wanted


CLASSES = (CURVE_OT_mobius_flow_show,)
