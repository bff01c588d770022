"""Operators for a run that goes on, or has ended: pause, keep, cancel, recover, and show where it was in trouble."""

import time

import bpy
import numpy as np

from ...core.base import Message, MobiusFlowError
from ...core.keys.placement import at
from ..curves.splines import control_points
from ..live import registry
from ..live.modal import Listening, report_end
from ..live.requirements import RELAXABLE, Condition, require
from ..live.run import LiveRun, RunState
from .button import Button, LiveButton, button

_GOING_ON = Condition("Nothing is being relaxed", lambda _: registry.current() is None)
_COMPUTING = Condition(
    "The relaxation is over; its keys are being written",
    lambda _: (run := registry.current()) is not None and run.state is RunState.FINISHING,
)
_TROUBLE = Condition(
    "This curve has no problem to show",
    lambda context: not ((run := registry.shown(context.active_object)) and run.state.over and run.trouble),
)
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


class CURVE_OT_mobius_flow_recover(Listening, LiveButton, bpy.types.Operator):
    """Keep what the last relaxation had reached when it was cancelled"""

    bl_label = "Recover"
    needs = (_RECOVERABLE,)

    def begin(self, context: bpy.types.Context) -> set[str]:
        return self.listen(context, self._recovered())

    def act(self, context: bpy.types.Context) -> None:
        run = self._recovered()
        while not run.state.over:
            run.tick()
            time.sleep(0.005)  # the keys are being prepared
        if run.state is not RunState.DONE:
            raise MobiusFlowError(run.message)
        report_end(self, context.scene, run)

    def _recovered(self) -> LiveRun:
        run = registry.latest()
        assert run is not None, "poll looks for it"
        require(RELAXABLE.of(run.session.objects))
        run.recover()
        return run


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
        points = [point for spline in obj.data.splines for point in control_points(spline)]
        chosen = at(np.array([point.co[:3] for point in points]), spot.points)
        for point, wanted in zip(points, chosen.tolist(), strict=True):
            if isinstance(point, bpy.types.BezierSplinePoint):
                point.select_control_point = wanted
                point.select_left_handle = point.select_right_handle = False
            else:
                point.select = wanted
    bpy.ops.object.mode_set(mode="EDIT")
    if context.region_data is not None:
        bpy.ops.view3d.view_selected()
