"""The live half of the operators that relax: how a run starts in a window, and what is said at its end."""

from typing import Any

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves import bake
from ..curves.pins import Held
from ..curves.session import Report
from ..curves.surroundings import Surroundings
from ..engine.key_options import KeyOptions
from ..properties import key_options, relax_options
from ..translations import rpt_
from . import registry
from .checks import edited, refusal, selected_curves, unsampled
from .modal import Loop
from .refresh import Refresh
from .run import Run, State


class Listening:
    """What an operator does in a window while a run goes on."""

    loop: Loop | None = None

    def listen(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Start the event loop of a run."""
        self.loop = Loop(run, context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle an event."""
        assert self.loop is not None, "invoke makes it"
        result = self.loop.handle(context, event)
        if self.loop.run.state.over:
            tell_end(self, context.scene, self.loop.run)
        return result

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender gives up the operator: its window or its file is closed."""
        if self.loop is not None:
            self.loop.abandon()


class LiveRelax(Listening):
    """What an operator that relaxes does in a window: `invoke` starts a worker, `modal` shows what it finds.

    Attributes
    ----------
    continues
        Whether baked curves are relaxed on from the ends of their animations.
    """

    continues = False

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Relax the selected curves live; ask first if smooth splines have to become polygons."""
        if bpy.app.background or context.window is None:
            return set(self.execute(context))
        context.view_layer.update()
        try:
            values = self.values(context)
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        if unsampled(selected_curves(context)) and not self.sample_splines:
            return set(bpy.ops.curve.mobius_flow_sample("INVOKE_DEFAULT")) and {"CANCELLED"}
        return self.begin(context, values)

    def begin(self, context: bpy.types.Context, values: dict[str, Any]) -> set[str]:
        """Start the run and its event loop."""
        try:
            if refused := refusal(context) or edited(context):
                raise MobiusFlowError(refused.sentence)
            options, refresh = self.key_options(context, values), Refresh(values["view_every"])
            objects = selected_curves(context)
            surroundings = Surroundings.of(values["avoid"], objects)
            run = Run(objects, relax_options(values), options, self.continues, refresh, surroundings, Held.of(values))
            registry.begin(run)
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        return self.listen(context, run)

    def key_options(self, context: bpy.types.Context, values: dict[str, Any]) -> KeyOptions:
        """How the run becomes an animation; raises OptionError."""
        options = key_options(values)
        return bake.continued(selected_curves(context), options) if self.continues else options


def tell_end(operator: Any, scene: bpy.types.Scene, run: Run) -> None:
    """Say how a run ended, and keep showing the shape that was kept."""
    if run.state is State.DONE and run.report is not None:
        if run.report.keys > 1:
            whole = int(run.report.last_frame // 1)
            scene.frame_set(whole, subframe=run.report.last_frame - whole)
        tell(operator, scene, run.report, failed=run.failed)
    else:
        operator.report({"ERROR"} if run.failed else {"INFO"}, rpt_(run.message))


def tell(operator: Any, scene: bpy.types.Scene, report: Report, failed: bool = False) -> None:
    """Say what was done, and whether the scene shows all of it."""
    hidden = unseen(scene, report.scene_range)
    clean = report.clean and not failed and hidden is None
    sentence = Message("{done}. {hidden}", done=report.sentence, hidden=hidden) if hidden else report.sentence
    operator.report({"INFO"} if clean else {"WARNING"}, rpt_(sentence))


def unseen(scene: bpy.types.Scene, animation: tuple[int, int] | None) -> Message | None:
    """Say that a scene does not play all frames of an animation, and what helps, or return None if it does."""
    if animation is None or (scene.frame_start <= animation[0] and animation[1] <= scene.frame_end):
        return None
    first, last = animation
    helps = Message("press Set Scene Range to see all of it")
    if first < scene.bl_rna.properties["frame_start"].hard_min:
        helps = Message("no scene plays negative frames, so bake again with a later Start Frame")
    return Message(
        "The scene plays frames {start} to {end} only, the animation has {first} to {last}: {helps}",
        start=scene.frame_start,
        end=scene.frame_end,
        first=first,
        last=last,
        helps=helps,
    )
