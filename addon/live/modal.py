"""A run in a window: its event loop, the operator that drives it, and the report at its end."""

from typing import Any

import bpy
import numpy as np

from ...core import Status
from ...core.base import Message
from ..curves.report import Report
from ..curves.sizes import placement
from ..translations import iface_, rpt_
from . import registry
from .drag import Drag, corner, size
from .run import LiveRun, RunState


class Loop:
    """The event loop: a timer in the window where a run was started and a line in its status bar, while it goes on."""

    def __init__(self, run: LiveRun, context: bpy.types.Context) -> None:
        self.run = run
        self._manager = context.window_manager
        self._timer = self._manager.event_timer_add(1 / 60, window=context.window)
        self._shown: tuple[object, ...] = ()
        self._abandoned = False
        run.on_end = self.close
        self._show(context)

    def handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle an event; most do not concern the relaxation, and Blender stays usable."""
        handled = {"PASS_THROUGH"}
        registry.history.look()
        registry.history.push(self.run)
        if self.run.state.over:
            pass  # ended by a handler, such as the one for undo
        elif event.type == "TIMER":
            self.run.tick()
        elif not self.run.waits and self._drag(context, event):
            handled = {"RUNNING_MODAL"}
        elif event.value == "PRESS" and not self.run.waits and _is_meant(context, event):
            handled, undo = {"RUNNING_MODAL"}, event.type == "Z" and (event.ctrl or event.oskey) and not event.shift
            if event.type == "ESC" and self.run.drag:
                self.run.take_back()
            elif event.type == "ESC" or (undo and not registry.history.others):
                self.run.cancel()
            elif event.type in {"RET", "NUMPAD_ENTER"}:
                self.run.keep()
            else:
                handled = {"PASS_THROUGH"}
        if self._visible() != self._shown:
            self._show(context)
        if self.run.state.over:
            return {"FINISHED"} if self.run.state is RunState.DONE else {"CANCELLED"}
        return handled

    def _drag(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Let the mouse drag what is relaxed; return whether the event was about that.

        A press with another modifier than Ctrl belongs to Blender; Ctrl, at the press or when letting go, leaves a pin.
        """
        run, mouse = self.run, np.array([event.mouse_x, event.mouse_y], dtype=np.float64)
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            if run.drag is not None:  # the release got lost, in another window
                run.let_go()
            if event.shift or event.alt or event.oskey or run.state.name != "RUNNING" or run.shown is None:
                return False
            # the region of a 3D view that has the mouse, unless a sidebar, a header or the navigation gizmo has it
            found, curve = [], run.session.in_view if run.may_be_dragged else None
            areas = context.window.screen.areas if context.window else []
            for region in (region for area in areas if area.type == "VIEW_3D" for region in area.regions):
                place, extent = mouse - corner(region), size(region)
                if (extent > 1).all() and (place >= 0).all() and (place < extent).all():
                    found.append(region)
            region = next((each for each in found if each.type == "WINDOW"), None)
            if (
                curve is None
                or region is None
                or any(each.type in {"UI", "TOOLS", "HEADER", "TOOL_HEADER"} for each in found)
            ):
                return False
            view, system = context.preferences.view, context.preferences.system
            gizmo = np.array([1.2, 4.0]) * view.gizmo_size_navigate_v3d * system.ui_scale
            if view.show_navigate_ui and (corner(region) + size(region) - mouse < gizmo).all():
                return False
            near = 15.0 * system.ui_scale  # pixels
            radius = max(placement(each).stretch * each.data.bevel_depth for each in run.session.objects)
            drag = Drag.at(curve, region, mouse - corner(region), near, radius)
            if drag is not None:
                drag.pins = event.ctrl
                run.grab(drag)
            return drag is not None
        if run.drag is None:
            return False
        if event.type == "MOUSEMOVE":
            run.pull(run.drag.under(mouse - corner(run.drag.region)))
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            run.let_go(pin=run.drag.pins or event.ctrl)
        else:
            return False
        return True

    def _visible(self) -> tuple[object, ...]:
        run = self.run
        return run.state, run.shown, run.looked_at, run.waits, id(run.drag and run.drag.target)

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


def status_line(run: LiveRun) -> str:
    if run.waits:
        return iface_("{names}: waiting for the render", names=run.name)
    if run.state is RunState.FINISHING:
        return iface_("{names}: proving and writing keys   |   Esc: put all back", names=run.name)
    where = Message("stopping" if run.stops else "starting")
    if run.last is not None:
        told = "step {index} ({measure} {energy:.4f})"
        where = Message(told, index=run.last.index, measure=run.measure, energy=run.last.energy)
    if run.looked_at is not None and run.last is not None:
        where = Message("looking back at step {index:.0f} of {last}", index=run.looked_at, last=run.last.index)
    elif run.state is RunState.PAUSED:
        where = Message("paused") if run.last is None else Message("paused at {where}", where=where)
    keys = Message("Enter: keep this shape   |   Esc: put all back")
    if run.may_be_dragged:
        keys = Message("Drag: pull a strand, Ctrl pins it   |   {keys}", keys=keys)
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

    def listen(self, context: bpy.types.Context, run: LiveRun) -> set[str]:
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


def report_end(operator: Any, scene: bpy.types.Scene, run: LiveRun) -> None:
    """Report how a run ended, and go to the frame of the shape that was kept."""
    if run.state is RunState.DONE and run.report is not None:
        if run.report.keys > 1:
            whole = int(run.report.last_frame // 1)
            scene.frame_set(whole, subframe=run.report.last_frame - whole)
        report_result(operator, scene, run.report, failed=run.failed)
    else:
        operator.report({"ERROR"} if run.failed else {"INFO"}, rpt_(run.message))


def report_result(operator: Any, scene: bpy.types.Scene, report: Report, failed: bool = False) -> None:
    """Report what was done, and whether the scene plays all of it."""
    hidden = unseen(scene, report.scene_range)
    clean = report.certified and report.outcome.status is not Status.STALLED and not failed and hidden is None
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
    sentence = "The scene plays frames {start} to {end} only, the animation has {first} to {last}: {helps}"
    return Message(sentence, start=scene.frame_start, end=scene.frame_end, first=first, last=last, helps=helps)
