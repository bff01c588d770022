"""The buttons for a run that is going on, or has been cancelled, and the question before one starts."""

import time
from collections.abc import Callable

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves import sampling
from ..live import registry
from ..live.checks import hindrance, selected_curves
from ..live.modal import redraw_views
from ..live.run import Run, State
from ..live.start import Listening, tell_end
from ..translations import iface_, rpt_, tip_

_NOTHING = Message("Nothing is being relaxed")
_WRITING = Message("The relaxation is over; its keys are being written")
_PATIENCE = 0.005  # seconds between looks at whether the keys are ready


class _RunButton:
    """A button for the run that is going on."""

    poll_message_set: Callable[[str], None]

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether there is a run that still computes."""
        run = registry.current()
        busy = run is not None and run.state is State.FINISHING
        cls.poll_message_set(tip_(_WRITING if busy else _NOTHING))
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
    """Stop here: keep the shape that the curves have now, and the motion up to it"""

    bl_idname = "curve.mobius_flow_stop"
    bl_label = "Keep"

    def act(self, run: Run) -> None:
        """Stop; the event loop writes the result."""
        run.keep()


class CURVE_OT_mobius_flow_cancel(bpy.types.Operator):  # noqa: N801
    """Stop, and put everything back as it was; Recover brings it back again"""

    bl_idname = "curve.mobius_flow_cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether there is a run, even one whose keys are being written."""
        cls.poll_message_set(tip_(_NOTHING))
        return registry.current() is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Put everything back."""
        run = registry.current()
        assert run is not None, "poll looks for it"
        run.cancel()
        redraw_views(context.window_manager)
        return {"FINISHED"}


class CURVE_OT_mobius_flow_recover(Listening, bpy.types.Operator):  # noqa: N801
    """Keep what the last relaxation had reached when it was cancelled"""

    bl_idname = "curve.mobius_flow_recover"
    bl_label = "Recover"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether there is something to recover."""
        run = registry.latest()
        cls.poll_message_set(tip_("No relaxation was cancelled"))
        return run is not None and run.recoverable

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Write the keys while Blender stays usable."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        run = self._recovered()
        return {"CANCELLED"} if run is None else self.listen(context, run)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the keys."""
        run = self._recovered()
        if run is None:
            return {"CANCELLED"}
        while not run.state.over:
            run.tick()
            time.sleep(_PATIENCE)
        tell_end(self, context.scene, run)
        return {"FINISHED"} if run.state is State.DONE else {"CANCELLED"}

    def _recovered(self) -> Run | None:
        run = registry.latest()
        assert run is not None, "poll looks for it"
        try:
            if refused := hindrance(run.group.objects):
                raise MobiusFlowError(refused.sentence)
            run.recover()
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return None
        return run


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
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        return set(context.window_manager.invoke_props_dialog(self, width=420))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show the questions."""
        for question in self.questions:
            self.layout.label(text=iface_(question), icon="QUESTION")
        self.layout.label(text=iface_("For more or fewer points change the curve's Resolution Preview U."))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Relax with the answer."""
        bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT", sample_splines=True)
        return {"FINISHED"}


CLASSES = (
    CURVE_OT_mobius_flow_pause,
    CURVE_OT_mobius_flow_stop,
    CURVE_OT_mobius_flow_cancel,
    CURVE_OT_mobius_flow_recover,
    CURVE_OT_mobius_flow_sample,
)
