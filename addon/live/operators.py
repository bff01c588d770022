"""The live half of the Relax operator, and the buttons for a run that is going on."""

from collections.abc import Callable
from typing import Any

import bpy

from ...core import MobiusFlowError
from ..curves import sampling
from ..properties import key_options, relax_options
from . import registry
from .checks import refusal, selected_curves, unsampled
from .modal import Loop, redraw_views
from .run import Run, State

_NOTHING = "Nothing is being relaxed"


class LiveRelax:
    """What the Relax operator does in a window: `invoke` starts a worker, `modal` shows what it finds."""

    loop: Loop | None = None

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Relax the selected curves live; ask first if smooth splines have to become polygons."""
        if bpy.app.background or context.window is None:
            return set(self.execute(context))
        context.view_layer.update()
        values = self.values(context)
        if unsampled(selected_curves(context)) and not self.sample_splines:
            return set(bpy.ops.curve.mobius_flow_sample("INVOKE_DEFAULT")) and {"CANCELLED"}
        return self.begin(context, values)

    def begin(self, context: bpy.types.Context, values: dict[str, Any]) -> set[str]:
        """Start the run and its event loop."""
        try:
            if reason := refusal(context):
                raise MobiusFlowError(reason)
            run = Run(selected_curves(context), relax_options(values), key_options(values))
            registry.begin(run)
        except MobiusFlowError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.loop = Loop(run, context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle an event."""
        assert self.loop is not None, "invoke makes it"
        result = self.loop.handle(context, event)
        run = self.loop.run
        if run.state is State.DONE and run.report is not None:
            _go_to_last_frame(context.scene, run.report.last_frame if run.report.keys > 1 else None)
            self.report({"INFO"} if run.report.clean and not run.failed else {"WARNING"}, run.message)
        elif run.state.over:
            self.report({"ERROR"} if run.failed else {"INFO"}, run.message)
        return result

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender gives up the operator: its window or its file is closed."""
        if self.loop is not None:
            self.loop.abandon()


def _go_to_last_frame(scene: bpy.types.Scene, frame: float | None) -> None:
    """Keep showing the shape that was kept."""
    if frame is not None:
        whole = int(frame // 1)
        scene.frame_set(whole, subframe=frame - whole)


class _RunButton:
    """A button for the run that is going on."""

    poll_message_set: Callable[[str], None]

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether there is a run that still computes."""
        run = registry.current()
        busy = run is not None and run.state is State.FINISHING
        cls.poll_message_set("The relaxation is over; its keys are being written" if busy else _NOTHING)
        return run is not None and not busy

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do what the button says."""
        run = registry.current()
        assert run is not None, "poll looks for it"
        self.act(run)
        redraw_views(context.window_manager)
        return {"FINISHED"}

    def act(self, run: Run) -> None:
        """What the button does."""
        raise NotImplementedError


class CURVE_OT_mobius_flow_pause(_RunButton, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Pause the relaxation, or go on with it"""

    bl_idname = "curve.mobius_flow_pause"
    bl_label = "Pause"

    def act(self, run: Run) -> None:
        """Pause or resume."""
        run.toggle_pause()


class CURVE_OT_mobius_flow_stop(_RunButton, bpy.types.Operator):  # noqa: N801
    """Stop the relaxation and keep the shape it has now"""

    bl_idname = "curve.mobius_flow_stop"
    bl_label = "Stop"

    def act(self, run: Run) -> None:
        """Stop; the event loop writes the result."""
        run.keep()


class CURVE_OT_mobius_flow_sample(bpy.types.Operator):  # noqa: N801
    """Ask whether smooth splines may become polygons, then relax"""

    bl_idname = "curve.mobius_flow_sample"
    bl_label = "Sample and Relax"
    bl_options = {"INTERNAL"}  # noqa: RUF012 - read by Blender

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask."""
        try:
            self.questions = sampling.questions(selected_curves(context))
        except MobiusFlowError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return set(context.window_manager.invoke_props_dialog(self, width=420))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show the questions."""
        for question in self.questions:
            self.layout.label(text=question, icon="QUESTION")
        self.layout.label(text="For more or fewer points change the curve's Resolution Preview U.")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Relax with the answer."""
        bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT", sample_splines=True)
        return {"FINISHED"}
