"""A run in a window: its event loop, the operator that drives it, and the report at its end."""

from typing import Any

import bpy

from ...core.messages import Message
from ..curves.session import Report
from ..translations import iface_, rpt_
from . import drag, registry
from .run import Run, State

_INTERVAL = 1 / 60  # seconds
_PASS = {"PASS_THROUGH"}


class Loop:
    """The event loop: a timer in the window where a run was started and a line in its status bar, while it goes on."""

    def __init__(self, run: Run, context: bpy.types.Context) -> None:
        self.run = run
        self._manager = context.window_manager
        self._timer = self._manager.event_timer_add(_INTERVAL, window=context.window)
        self._shown: tuple[object, ...] = ()
        self._abandoned = False
        run.on_end = self.close
        self._show(context)

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle an event; most do not concern the relaxation, and Blender stays usable."""
        handled = _PASS
        registry.history.look()
        registry.history.push(self.run)
        if self.run.state.over:
            pass  # ended by a handler, such as the one for undo
        elif event.type == "TIMER":
            self.run.tick()
        elif not self.run.waits and drag.handle(self.run, context, event):
            handled = {"RUNNING_MODAL"}
        elif event.value == "PRESS" and not self.run.waits and _is_meant(context, event):
            handled = self._key(event)
        if self._visible() != self._shown:
            self._show(context)
        if self.run.state.over:
            return {"FINISHED"} if self.run.state is State.DONE else {"CANCELLED"}
        return handled

    def _visible(self) -> tuple[object, ...]:
        return (
            self.run.state,
            self.run.shown,
            self.run.looked_at,
            self.run.waits,
            id(self.run.drag and self.run.drag.target),
        )

    def _key(self, event: bpy.types.Event) -> set[str]:
        undo = event.type == "Z" and (event.ctrl or event.oskey) and not event.shift
        if self.run.drag and event.type == "ESC":
            self.run.take_back()
        elif event.type == "ESC" or (undo and not registry.history.others):
            self.run.cancel()
        elif event.type in {"RET", "NUMPAD_ENTER"}:
            self.run.keep()
        else:
            return _PASS
        return {"RUNNING_MODAL"}

    def close(self) -> None:
        """Take the timer and the line in the status bar away; the run calls this when it ends."""
        if self._timer is not None:
            self._manager.event_timer_remove(self._timer)
            self._timer = None
        if self._abandoned:  # the place in the context is about to go, and must not be changed under Blender's feet
            bpy.app.timers.register(clear_status)
        else:
            clear_status()

    def abandon(self) -> None:
        """Called when Blender closes the window of the run, or its file."""
        self._abandoned = True
        self.run.cancel(Message("The window was closed; all is as it was"))

    def _show(self, context: bpy.types.Context) -> None:
        self._shown = self._visible()
        if not self.run.state.over and context.window is not None:
            context.workspace.status_text_set(status_line(self.run))
        redraw_views(context.window_manager)


def clear_status() -> None:
    """Return the status bars of all windows to Blender."""
    for window in bpy.context.window_manager.windows:
        # Blender takes the place from the context, and crashes where there is none
        with bpy.context.temp_override(window=window):
            window.workspace.status_text_set(None)


def status_line(run: Run) -> str:
    if run.waits:
        return iface_("{names}: waiting for the render", names=run.name)
    if run.state is State.FINISHING:
        return iface_("{names}: proving and writing keys   |   Esc: put all back", names=run.name)
    where = Message("starting")
    if run.last is not None:
        where = Message("iterate {index}, energy {energy:.4f}", index=run.last.index, energy=run.last.energy)
    if run.looked_at is not None and run.last is not None:
        where = Message("looking back at iterate {index:.0f} of {last}", index=run.looked_at, last=run.last.index)
    elif run.state is State.PAUSED:
        where = Message("paused") if run.last is None else Message("paused at {where}", where=where)
    keys = Message("Drag: pull a strand, Ctrl pins it   |   Enter: keep this shape   |   Esc: put all back")
    return iface_("{names}: {where}   |   {keys}", names=run.name, where=where, keys=keys)


def redraw_views(manager: bpy.types.WindowManager) -> None:
    """Redraw the 3D views and their sidebars, which points moved by Python do not cause."""
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _is_meant(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Whether a key is meant for the run: the mouse is over a 3D view, and no playback is there to be stopped."""
    screen = context.window.screen if context.window else None
    if screen is None:
        return True
    x, y = event.mouse_x, event.mouse_y
    return not screen.is_animation_playing and any(
        area.type == "VIEW_3D" and 0 <= x - area.x < area.width and 0 <= y - area.y < area.height
        for area in screen.areas
    )


class Listening:
    """An operator that runs the event loop of a run."""

    events: Loop | None = None  # `loop` is a setting

    def listen(self, context: bpy.types.Context, run: Run) -> set[str]:
        self.events = Loop(run, context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        assert self.events is not None, "invoke makes it"
        result = self.events.handle(context, event)
        if self.events.run.state.over:
            report_end(self, context.scene, self.events.run)
        return result

    def cancel(self, context: bpy.types.Context) -> None:
        """Called when Blender closes the operator's window or file."""
        if self.events is not None:
            self.events.abandon()


def report_end(operator: Any, scene: bpy.types.Scene, run: Run) -> None:
    """Report how a run ended, and go to the frame of the shape that was kept."""
    if run.state is State.DONE and run.report is not None:
        if run.report.keys > 1:
            whole = int(run.report.last_frame // 1)
            scene.frame_set(whole, subframe=run.report.last_frame - whole)
        report_result(operator, scene, run.report, failed=run.failed)
    else:
        operator.report({"ERROR"} if run.failed else {"INFO"}, rpt_(run.message))


def report_result(operator: Any, scene: bpy.types.Scene, report: Report, failed: bool = False) -> None:
    """Report what was done, and whether the scene plays all of it."""
    hidden = unseen(scene, report.scene_range)
    clean = report.clean and not failed and hidden is None
    sentence = Message("{done}. {hidden}", done=report.sentence, hidden=hidden) if hidden else report.sentence
    operator.report({"INFO"} if clean else {"WARNING"}, rpt_(sentence))


def unseen(scene: bpy.types.Scene, animation: tuple[int, int] | None) -> Message | None:
    """The warning that a scene does not play all frames of an animation, or None if it does."""
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
