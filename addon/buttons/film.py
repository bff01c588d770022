"""A stage for the selected curves, and a film of what the scene shows."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves.world_motion import drawn_radius
from ..engine.words import named
from ..live.checks import running, selected_curves, unreadable
from ..live.refusal import Refusal
from ..pictures import staging
from ..pictures.filming import Filming, is_rendering, target
from ..pictures.looks import LOOKS
from ..scripting import Relaxation
from ..translations import iface_, rpt_
from .refusing import Refusing

_INTERVAL = 0.2  # seconds between looks at whether a render is over


class CURVE_OT_mobius_flow_set_up_stage(Refusing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Put a camera, lights, a floor and a sky around the selected curves, for as long as they move. \
Your own lights stay; your camera and your world come back with Remove Stage"""

    bl_idname = "curve.mobius_flow_set_up_stage"
    bl_label = "Set Up Stage"

    use_camera: BoolProperty(
        name="Use Camera", description="Render through the stage's camera instead of your own", default=True
    )
    use_world: BoolProperty(
        name="Use World", description="Render under the stage's sky instead of your own world", default=True
    )

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """The curves must be drawn."""
        return unreadable(context)

    def act(self, context: bpy.types.Context) -> None:
        """Set it up."""
        objects = selected_curves(context)
        Relaxation(*objects).set_up_stage(self.use_camera, self.use_world)
        thin = [obj.name for obj in objects if not obj.hide_render and not drawn_radius(obj)]
        if thin:
            sentence = "Renders do not show {names}, as there is no tube: press Fit Tube"
            self.report({"WARNING"}, rpt_(sentence, names=named(thin)))


class CURVE_OT_mobius_flow_remove_stage(Refusing, bpy.types.Operator):  # noqa: N801
    """Take the stage away, and use your own camera and world again"""

    bl_idname = "curve.mobius_flow_remove_stage"
    bl_label = "Remove Stage"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """There must be one."""
        if staging.own_stage(context.scene):
            return None
        return Refusal(Message("The scene has no stage; press Set Up Stage first"))

    def act(self, context: bpy.types.Context) -> None:
        """Take it away."""
        staging.strike(context.scene)


class _OfFilm:
    """What is asked of a film; what is not given comes from the scene's settings."""

    __annotations__ = {
        "filepath": StringProperty(name="File", description="Where the film goes", options={"SKIP_SAVE", "HIDDEN"}),
        "look": EnumProperty(
            name="Look",
            description="How the frames are rendered",
            items=[(name, look.label, look.description) for name, look in LOOKS.items()],
            options={"SKIP_SAVE", "HIDDEN"},
        ),
    }

    def given(self) -> dict[str, Any]:
        """What is given."""
        return {name: getattr(self, name) for name in ("filepath", "look") if self.properties.is_property_set(name)}

    def wanted(self, context: bpy.types.Context) -> tuple[str, str]:
        """File and look."""
        settings, given = context.scene.mobius_flow_film, self.given()
        return given.get("filepath", settings.filepath), given.get("look", settings.look)


class CURVE_OT_mobius_flow_render_film(_OfFilm, Refusing, bpy.types.Operator):  # noqa: N801
    """Render all frames that the scene plays to an MP4. Esc over the render's window cancels, and leaves no file"""

    bl_idname = "curve.mobius_flow_render_film"
    bl_label = "Render Film"
    bl_options = {"REGISTER"}  # noqa: RUF012 - read by Blender
    __annotations__ = {
        "overwrite": BoolProperty(
            name="Overwrite", description="Replace a file that is there", options={"SKIP_SAVE", "HIDDEN"}
        ),
        **_OfFilm.__annotations__,
    }

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """There must be a camera, and nothing else going on."""
        if is_rendering():
            return Refusal(Message("Blender is rendering; wait until it is done, or stop it with Esc"))
        if context.scene.camera is None:
            return running() or Refusal(Message("The scene has no camera; press Set Up Stage first"))
        return running()

    def act(self, context: bpy.types.Context) -> None:
        """Render it in this call."""
        filming = Filming(context.scene, *self.wanted(context), self.overwrite)
        filming.render()
        self.report({"INFO"}, rpt_(_made(filming)))

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Render it while Blender stays usable; ask first if there is such a file."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            path, look = self.wanted(context)
            if target(path).exists() and not self.overwrite:
                bpy.ops.curve.mobius_flow_replace_film("INVOKE_DEFAULT", **self.given())
                return {"CANCELLED"}
            self.filming = Filming(context.scene, path, look, self.overwrite)
            self.filming.start()
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(_INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for the end of the render."""
        if event.type != "TIMER" or is_rendering():
            return {"PASS_THROUGH"}
        if not self._end(context):
            self.report({"WARNING"}, rpt_("The film was not rendered to its end; no file was written"))
            return {"CANCELLED"}
        self.report({"INFO"}, rpt_(_made(self.filming)))
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender gives up the operator: its window or its file is closed."""
        self._end(context)

    def _end(self, context: bpy.types.Context) -> bool:
        context.window_manager.event_timer_remove(self.timer)
        return self.filming.finish()


class CURVE_OT_mobius_flow_replace_film(_OfFilm, bpy.types.Operator):  # noqa: N801
    """Ask whether a film that is there may be replaced, then render"""

    bl_idname = "curve.mobius_flow_replace_film"
    bl_label = "Overwrite"
    bl_options = {"INTERNAL"}  # noqa: RUF012

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask."""
        message = iface_("{name} is there already", name=target(self.wanted(context)[0]).name)
        title = iface_("Overwrite the film?")
        manager = context.window_manager
        return set(manager.invoke_confirm(self, event, title=title, message=message, icon="WARNING"))

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Render with the answer."""
        bpy.ops.curve.mobius_flow_render_film("INVOKE_DEFAULT", overwrite=True, **self.given())
        return {"FINISHED"}


def _made(filming: Filming) -> Message:
    return Message("A film of {count} frames: {path}", count=filming.frames, path=filming.path)


CLASSES = (
    CURVE_OT_mobius_flow_set_up_stage,
    CURVE_OT_mobius_flow_remove_stage,
    CURVE_OT_mobius_flow_render_film,
    CURVE_OT_mobius_flow_replace_film,
)
