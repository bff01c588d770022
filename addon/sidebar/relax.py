"""The panel in the sidebar: what is done first, and how it goes."""

from collections.abc import Sequence

import bpy

from ...core.messages import Message
from ..buttons.presets import VIEW3D_PT_mobius_flow_presets
from ..curves import surroundings
from ..curves.exchange import length
from ..curves.moving import unsteady
from ..engine.quality import QUALITIES
from ..engine.words import named, time_left
from ..live import registry
from ..live.checks import RELAXABLE
from ..live.requirements import avoided, selected_curves
from ..live.run import Run, State
from ..translations import iface_
from .layout import InSidebar, operator, refused, sentence, value


def _buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The large buttons; they and the rows below them keep their places whatever is said."""
    run, objects = registry.current(), _concerned(context)
    several = iface_("Relax {count} Curves Together", count=len(objects))
    text = several if len(objects) > 1 else iface_("Relax")
    large = layout.row(align=True)
    large.scale_y = 1.8
    if run is None:
        operator(large, "relax", text=text, icon="PLAY")
        operator(large, "morph", text="", icon="MOD_SIMPLEDEFORM")
        operator(large, "grab", text="", icon="VIEW_PAN")
    else:
        text, icon = (iface_("Resume"), "PLAY") if run.state is State.PAUSED else (iface_("Pause"), "PAUSE")
        operator(large, "pause", text=text, icon=icon)
        operator(large, "stop", icon="CHECKMARK")
        operator(large, "cancel", icon="X")


def _concerned(context: bpy.types.Context) -> Sequence[bpy.types.Object]:
    run = registry.current()
    return run.group.objects if run is not None else selected_curves(context)


def _hints(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Why Relax is disabled, and what helps; what might be crossed; what can be brought back."""
    run, shown, objects = registry.current(), registry.shown(context.active_object), _concerned(context)
    if shown is not None and shown.recoverable:
        operator(layout, "recover", icon="RECOVER_LAST")
    hindered = RELAXABLE(context)
    if hindered and (run is None or any(obj not in objects for obj in selected_curves(context))):
        refused(layout.column(align=True), context, hindered)
    if run or not hindered:
        # say what cannot be avoided, or else what might be crossed, with the button that helps
        found = avoided(context)
        if moving := unsteady(found, selected_curves(context)):
            sentence(layout, context, moving, icon="ERROR")
        elif unguarded := surroundings.warning(context, objects, found):
            sentence(layout, context, unguarded, icon="ERROR")
            operator(layout, "avoid", icon="ADD")


def _state(run: Run) -> Message:
    if run.waits:
        return Message("Waiting for the render")
    seconds = run.time_left.seconds if run.state is State.RUNNING and run.drag is None else None
    if seconds is not None:
        return Message("{state}, {time}", state=run.state.value, time=time_left(seconds))
    return Message("Failed") if run.failed and run.state is State.CANCELLED else run.state.value


def _progress(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """What is known of the run that is going on, or of the last one."""
    run = registry.shown(context.active_object)
    if run is None:
        return
    box = layout.box().column(align=True)
    value(box, ", ".join(run.group.names), _state(run))
    if run.last is not None:
        value(box, "Energy", f"{run.last.energy:.4f}")
        if run.target is not None:
            value(box, "At least", run.target.label)
        back = run.looked_at
        value(box, "Iteration", f"{run.last.index}" if back is None else f"{back:.0f} / {run.last.index}")
        proved = run.last.certified if run.report is None else run.report.certified
        whom = Message("with itself") if len(run.group.names) == 1 else Message("among themselves")
        value(box, "Free of contact", whom if proved else Message("not proved"))
        if run.avoided:
            value(box, "Avoided", named(run.avoided))
    if run.report is not None and run.report.radius is not None:
        value(box, "Tube radius", length(context.scene, run.report.radius))
    if run.message:
        sentence(box, context, run.message, icon="ERROR" if run.failed else "INFO")
    if run.trouble and run.state.over:
        operator(box, "show", icon="VIEWZOOM")
    if run.energies:
        row = box.row()
        row.use_property_split = False
        row.prop(context.scene.mobius_flow_panel, "show_plot")


def _quality(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    panel = context.scene.mobius_flow_panel
    row = layout.row(align=True)
    row.use_property_split = False
    for name in QUALITIES:
        row.prop_enum(panel, "quality", name)


def _add_knot(layout: bpy.types.UILayout, _context: bpy.types.Context) -> None:
    operator(layout, "add_knot", text="Add Knot", icon="ADD")


class VIEW3D_PT_mobius_flow(InSidebar, bpy.types.Panel):
    bl_label = "Möbius Flow"
    rows = (_buttons, _quality, _add_knot, _hints, _progress)

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        VIEW3D_PT_mobius_flow_presets.draw_panel_header(self.layout)
