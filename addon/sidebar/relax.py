"""The panel in the sidebar: what is done first, and how it goes."""

import bpy

from ...core.messages import Message
from ..buttons.add_knot import CURVE_OT_mobius_flow_add_knot
from ..buttons.relaxing import CURVE_OT_mobius_flow_relax
from ..buttons.running import (
    CURVE_OT_mobius_flow_cancel,
    CURVE_OT_mobius_flow_pause,
    CURVE_OT_mobius_flow_recover,
    CURVE_OT_mobius_flow_stop,
)
from ..buttons.showing import CURVE_OT_mobius_flow_show
from ..curves.units import length
from ..engine.quality import QUALITIES
from ..engine.words import named
from ..live import registry
from ..live.checks import refusal, selected_curves
from ..live.run import Run, State
from ..translations import iface_
from .labels import sentence
from .layout import InSidebar, value
from .presets import VIEW3D_PT_mobius_flow_presets
from .refused import refused
from .surroundings import warned

_STATES = {
    State.RUNNING: Message("Running"),
    State.PAUSED: Message("Paused"),
    State.FINISHING: Message("Finishing"),
    State.DONE: Message("Done"),
    State.CANCELLED: Message("Cancelled"),
    State.LOST: Message("Lost"),
}


class VIEW3D_PT_mobius_flow(InSidebar, bpy.types.Panel):  # noqa: N801 - Blender's naming scheme
    """The buttons, how the relaxation goes, and settings; when Relax is disabled, the reason stands below it."""

    bl_label = "Möbius Flow"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Put the menu of presets into the panel's head."""
        VIEW3D_PT_mobius_flow_presets.draw_panel_header(self.layout)

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in buttons, what is known of the run, and the quality."""
        run = registry.shown(context.active_object)
        _buttons(layout, context, run)
        if run is not None:
            _progress(layout, context, run)
        _quality(layout, context.scene.mobius_flow_panel)
        layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, text="Add Knot", icon="ADD")


def _quality(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    column = layout.column(align=True)
    column.use_property_split = False
    title = iface_("Quality" if panel.quality in QUALITIES else "Quality: Custom, see Expert")
    column.label(text=title, translate=False)
    row = column.row(align=True)
    for name in QUALITIES:
        row.prop_enum(panel, "quality", name)


def _buttons(layout: bpy.types.UILayout, context: bpy.types.Context, shown: Run | None) -> None:
    run = registry.current()
    column = layout.column(align=True)
    objects = run.group.objects if run is not None else selected_curves(context)
    several = iface_("Relax {count} Curves Together", count=len(objects))
    text = several if len(objects) > 1 else iface_("Relax")
    large = column.row(align=True)
    large.scale_y = 1.8
    if run is None:
        large.operator(CURVE_OT_mobius_flow_relax.bl_idname, text=text, icon="PLAY")
    else:
        _run_buttons(large, run)
    if shown is not None and shown.recoverable:
        column.operator(CURVE_OT_mobius_flow_recover.bl_idname, icon="RECOVER_LAST")
    hindered = refusal(context)
    if hindered and (run is None or any(obj not in objects for obj in selected_curves(context))):
        refused(column, context, hindered)
    if run or not hindered:
        warned(layout, context, objects)


def _run_buttons(row: bpy.types.UILayout, run: Run) -> None:
    text, icon = (iface_("Resume"), "PLAY") if run.state is State.PAUSED else (iface_("Pause"), "PAUSE")
    row.operator(CURVE_OT_mobius_flow_pause.bl_idname, text=text, icon=icon)
    row.operator(CURVE_OT_mobius_flow_stop.bl_idname, icon="CHECKMARK")
    row.operator(CURVE_OT_mobius_flow_cancel.bl_idname, icon="X")


def _state(run: Run) -> Message:
    if run.waits:
        return Message("Waiting for the render")
    return Message("Failed") if run.failed and run.state is State.CANCELLED else _STATES[run.state]


def _progress(layout: bpy.types.UILayout, context: bpy.types.Context, run: Run) -> None:
    """What is known of the run that is going on, or of the last one."""
    box = layout.box().column(align=True)
    value(box, ", ".join(run.group.names), _state(run))
    if run.last is not None:
        value(box, "Energy", f"{run.last.energy:.4f}")
        if run.target is not None:
            value(box, "At least", run.target.label)
        value(box, "Iteration", f"{run.last.index}")
        value(box, "Step", f"{run.last.step_size:.3g}")
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
        box.operator(CURVE_OT_mobius_flow_show.bl_idname, icon="VIEWZOOM")
    if run.energies:
        row = box.row()
        row.use_property_split = False
        row.prop(context.scene.mobius_flow_panel, "show_plot")


CLASSES = (VIEW3D_PT_mobius_flow,)
