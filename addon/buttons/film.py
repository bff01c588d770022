"""A stage for the selected curves, and a film of what the scene shows."""

from contextlib import suppress
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from ...core.base import Message, MobiusFlowError
from ...core.driver.words import named, time_left
from ..curves.recorded import drawn_radius
from ..live.modal import clear_status
from ..live.requirements import FILMABLE, Condition, idle
from ..live.selection import shown_curves
from ..pictures import staging
from ..pictures.movie import CHOICES, Filming, is_rendering, play, target
from ..scripting import Relaxation
from ..translations import iface_, rpt_
from .button import Button, LiveButton, button, offer

_STAGE = Condition(
    "The scene has no stage; press Set Up Stage first", lambda context: not staging.own_stage(context.scene)
)
_CAMERA = Condition("The scene has no camera; press Set Up Stage first", lambda context: context.scene.camera is None)
_FREE = Condition("Blender is rendering; wait until it is done, or stop it with Esc", lambda _context: is_rendering())


class CURVE_OT_mobius_flow_set_up_stage(Button, bpy.types.Operator):
    """Put a camera, lights, a floor and a sky around the selected curves, for as long as they move. \
Your own lights stay; your camera and your world come back with Remove Stage"""

    bl_label = "Set Up Stage"
    needs = (FILMABLE,)

    use_camera: BoolProperty(
        name="Use Camera", description="Render through the stage's camera instead of your own", default=True
    )
    use_world: BoolProperty(
        name="Use World", description="Render under the stage's sky instead of your own world", default=True
    )
    hide_others: BoolProperty(
        name="Hide Others",
        description="Leave all other objects out of renders until Remove Stage, but for lights and what curves avoid",
        default=True,
    )

    def act(self, context: bpy.types.Context) -> None:
        objects = shown_curves(context)
        look = context.scene.mobius_flow_film.look
        made = Relaxation(*objects).set_up_stage(self.use_camera, self.use_world, look, self.hide_others)
        if others := staging.kept(made, staging.HIDDEN):
            sentence = "Renders leave out {names} until you press Remove Stage"
            self.report({"INFO"}, rpt_(sentence, names=named([obj.name for obj in others])))
        thin = [obj.name for obj in objects if not obj.hide_render and not drawn_radius(obj)]
        if thin:
            sentence = "Renders do not show {names}, as there is no tube: press Fit Tube"
            self.report({"WARNING"}, rpt_(sentence, names=named(thin)))


@button("Remove Stage", _STAGE)
def remove_stage(_operator: Button, context: bpy.types.Context) -> None:
    """Take the stage away, and use your own camera and world again"""
    staging.strike(context.scene)


_SCRIPTED = {"SKIP_SAVE", "HIDDEN"}


class CURVE_OT_mobius_flow_render_film(LiveButton, bpy.types.Operator):
    """Render all frames that the scene plays to an MP4. Esc over the render's window cancels, and leaves no file"""

    bl_label = "Render Film"
    bl_options = {"REGISTER"}
    needs = (_FREE, idle, _CAMERA)

    # by default those of the scene's settings
    filepath: StringProperty(name="File", description="Where the film goes", options=_SCRIPTED)
    look: EnumProperty(
        name="Look",
        description="What the stage and the curves on it are made of, and how frames are rendered",
        items=[(name, *words) for name, words in CHOICES.items()],
        options=_SCRIPTED,
    )
    overwrite: BoolProperty(name="Overwrite", description="Replace an existing file", options=_SCRIPTED)

    def given(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in ("filepath", "look") if self.properties.is_property_set(name)}

    def wanted(self, context: bpy.types.Context) -> tuple[str, str]:
        settings, given = context.scene.mobius_flow_film, self.given()
        return given.get("filepath", settings.filepath), given.get("look", settings.look)

    def act(self, context: bpy.types.Context) -> None:
        self.filming = Filming(context.scene, *self.wanted(context), self.overwrite)
        self.filming.render()
        self._report_film()

    def asks(self, context: bpy.types.Context) -> bool:
        """Ask whether a film that is there may be replaced."""
        path = target(self.wanted(context)[0])
        replace = {Message("Overwrite"): (type(self).bl_idname, self.given() | {"overwrite": True})}
        there = path.exists() and not self.overwrite
        return there and offer(context, Message("{name} is there already", name=path.name), replace)

    def begin(self, context: bpy.types.Context) -> set[str]:
        self.filming = Filming(context.scene, *self.wanted(context), self.overwrite)
        self.filming.start()
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "TIMER" or is_rendering():
            made = self.filming
            progress = Message("Rendering the film: {done} of {count} frames", done=made.done, count=made.frames)
            if (seconds := made.seconds_left) is not None:
                progress = Message("{state}, {time}", state=progress, time=time_left(seconds))
            if context.workspace is not None:
                context.workspace.status_text_set(iface_(progress))
            return {"PASS_THROUGH"}
        if not self._end(context):
            self.report({"WARNING"}, rpt_("The film was not finished; no file was written"))
            return {"CANCELLED"}
        self._report_film()
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Called when Blender closes the operator's window or file."""
        self._end(context)

    def _end(self, context: bpy.types.Context) -> bool:
        context.window_manager.event_timer_remove(self.timer)
        clear_status()
        return self.filming.finish()

    def _report_film(self) -> None:
        made = self.filming
        self.report({"INFO"}, rpt_("A film of {count} frames: {path}", count=made.frames, path=made.path))


def _is_missing(context: bpy.types.Context) -> bool:
    with suppress(MobiusFlowError):
        return not target(context.scene.mobius_flow_film.filepath).is_file()
    return True


_MADE = Condition("There is no film at this place; press Render Film first", _is_missing)


@button("Play Film", _MADE, bl_options=set())
def play_film(_operator: Button, context: bpy.types.Context) -> None:
    """Play the film that was rendered"""
    play(target(context.scene.mobius_flow_film.filepath))
