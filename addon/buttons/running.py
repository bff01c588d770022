"""Buttons for a run that is in progress, cancelled or stuck, and the question asked before one starts."""

import time

import bpy
import numpy as np

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves.splines import control_points, questions
from ..engine.placement import Spot, at
from ..live import registry
from ..live.checks import RELAXABLE
from ..live.modal import Listening, report_end
from ..live.requirements import Condition, require, selected_curves
from ..live.run import Run, State
from ..translations import iface_
from .button import Button, button

_PATIENCE = 0.005  # seconds between checks whether the keys are ready


def _has_no_trouble(context: bpy.types.Context) -> bool:
    run = registry.shown(context.active_object)
    return run is None or not run.state.over or not run.trouble


_GOING_ON = Condition("Nothing is being relaxed", lambda _: registry.current() is None)
_COMPUTING = Condition(
    "The relaxation is over; its keys are being written",
    lambda _: (run := registry.current()) is not None and run.state is State.FINISHING,
)
_TROUBLE = Condition("This curve has no problem to show", _has_no_trouble)
_RECOVERABLE = Condition(
    "No relaxation was cancelled", lambda _: (run := registry.latest()) is None or not run.recoverable
)


@button("Pause", _COMPUTING, _GOING_ON, bl_options=set())
def pause(_operator: Button, _context: bpy.types.Context) -> None:
    """Pause the relaxation, or go on with it"""
    registry.current().toggle_pause()


@button("Keep", _COMPUTING, _GOING_ON, bl_options=set())
def stop(_operator: Button, _context: bpy.types.Context) -> None:
    """Stop here: keep the shape that the curves have now, and the motion up to it"""
    registry.current().keep()  # the event loop writes the result


@button("Cancel", _GOING_ON, bl_options=set())
def cancel(_operator: Button, _context: bpy.types.Context) -> None:
    """Stop, and put everything back as it was; Recover brings it back again"""
    registry.current().cancel()


class CURVE_OT_mobius_flow_recover(Listening, Button, bpy.types.Operator):
    """Keep what the last relaxation had reached when it was cancelled"""

    bl_label = "Recover"
    needs = (_RECOVERABLE,)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Write the keys while Blender stays usable."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            return self.listen(context, self._recovered())
        except MobiusFlowError as error:
            return self.fail(error)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            run = self._recovered()
        except MobiusFlowError as error:
            return self.fail(error)
        while not run.state.over:
            run.tick()
            time.sleep(_PATIENCE)
        report_end(self, context.scene, run)
        return {"FINISHED"} if run.state is State.DONE else {"CANCELLED"}

    def _recovered(self) -> Run:
        run = registry.latest()
        assert run is not None, "poll looks for it"
        require(RELAXABLE.of(run.group.objects))
        run.recover()
        return run


class CURVE_OT_mobius_flow_sample(Button, bpy.types.Operator):
    """Ask whether smooth splines may become polygons, then relax"""

    bl_label = "Sample and Relax"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        try:
            self.questions = questions(selected_curves(context))
        except MobiusFlowError as error:
            return self.fail(error)
        return set(context.window_manager.invoke_props_dialog(self, width=420))

    def draw(self, _context: bpy.types.Context) -> None:
        for question in self.questions:
            self.layout.label(text=iface_(question), icon="QUESTION")
        self.layout.label(text=iface_("For more or fewer points change the curve's Resolution Preview U."))

    def act(self, _context: bpy.types.Context) -> None:
        bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT", sample_splines=True)


@button("Show", _TROUBLE)
def show(_operator: Button, context: bpy.types.Context) -> None:
    """Select the points that the message is about, in Edit Mode"""
    run = registry.shown(context.active_object)
    spots = {obj: spot for obj, spot in run.spots.items() if obj.visible_get()}
    if not spots:
        sentence = "The curve is hidden, or not in this view layer; make it visible first"
        raise MobiusFlowError(Message(sentence))
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


def _select(data: bpy.types.Curve, spot: Spot) -> None:
    points = [point for spline in data.splines for point in control_points(spline)]
    chosen = at(np.array([point.co[:3] for point in points]), spot.points)
    for point, wanted in zip(points, chosen.tolist(), strict=True):
        if isinstance(point, bpy.types.BezierSplinePoint):
            point.select_control_point = wanted
            point.select_left_handle = point.select_right_handle = False
        else:
            point.select = wanted
