"""The sidebar panel and the entry in the Add menu."""

import bpy

from . import labels
from .baking import (
    CURVE_OT_mobius_flow_bake_again,
    CURVE_OT_mobius_flow_clear,
    CURVE_OT_mobius_flow_continue,
    CURVE_OT_mobius_flow_scene_range,
)
from .curves import bake, neighbours
from .engine.key_options import Output
from .engine.timing import Pace
from .live import registry
from .live.checks import refusal, selected_curves
from .live.operators import (
    CURVE_OT_mobius_flow_cancel,
    CURVE_OT_mobius_flow_pause,
    CURVE_OT_mobius_flow_recover,
    CURVE_OT_mobius_flow_stop,
)
from .live.run import Run, State
from .live.start import unseen
from .operators import CURVE_OT_mobius_flow_add_knot, CURVE_OT_mobius_flow_relax
from .properties import shown


class _InSidebar:
    """A panel in our tab of the sidebar, with the names of settings before them."""

    bl_category = "Möbius Flow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    layout: bpy.types.UILayout

    def draw(self, context: bpy.types.Context) -> None:
        """Lay the panel out."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.fill(self.layout, context, context.scene.mobius_flow)

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in what the panel is for."""
        raise NotImplementedError


class VIEW3D_PT_mobius_flow(_InSidebar, bpy.types.Panel):  # noqa: N801 - Blender's naming scheme
    """The buttons, how the relaxation goes, and settings; when Relax is disabled, the reason stands below it."""

    bl_label = "Möbius Flow"

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in buttons, what is known of the run, and the basic settings."""
        _buttons(layout, context)
        if run := registry.latest():
            _progress(layout, context, run)
        elif context.active_object and context.active_object.type == "CURVE":
            _value(layout, "Tube radius", f"{context.active_object.data.bevel_depth:.4g}")
        _column(layout, settings, *(option.name for option in shown("basic")))
        layout.prop(settings, "fit_bevel")
        layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, text="Add Knot", icon="ADD")


class VIEW3D_PT_mobius_flow_animation(_InSidebar, bpy.types.Panel):  # noqa: N801
    """How the motion is kept as keyframes, and what can be done with them afterwards."""

    bl_label = "Animation"
    bl_parent_id = "VIEW3D_PT_mobius_flow"

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in buttons for curves that were baked, then settings."""
        _bake_buttons(layout, context)
        animated = settings.keyframes != Output.RESULT.name
        if animated:
            lasting = "frames_per_iterate" if settings.timing == Pace.ITERATE.name else "length"
            _column(layout, settings, "timing", lasting, "start_frame", "hold_start", "hold_end")
        _column(layout, settings, "keyframes", *(["max_keys"] if animated else []))


class VIEW3D_PT_mobius_flow_advanced(_InSidebar, bpy.types.Panel):  # noqa: N801
    """The options for those who know the mathematics."""

    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - read by Blender

    def fill(self, layout: bpy.types.UILayout, _context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put them all in."""
        _column(layout, settings, *(option.name for option in shown("advanced")))
        _column(layout, settings, "view_every")


CLASSES = (VIEW3D_PT_mobius_flow, VIEW3D_PT_mobius_flow_animation, VIEW3D_PT_mobius_flow_advanced)


def add_menu_entry(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Offer knots in Add > Curve."""
    menu.layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, icon="CURVE_NCIRCLE")


def _buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    run = registry.current()
    column = layout.column(align=True)
    objects = run.group.objects if run is not None else selected_curves(context)
    text = f"Relax {len(objects)} Curves Together" if len(objects) > 1 else "Relax"
    large = column.row(align=True)
    large.scale_y = 1.8
    if run is None:
        large.operator(CURVE_OT_mobius_flow_relax.bl_idname, text=text, icon="PLAY")
    else:
        _run_buttons(large, run)
    latest = registry.latest()
    if latest is not None and latest.recoverable:
        column.operator(CURVE_OT_mobius_flow_recover.bl_idname, icon="RECOVER_LAST")
    reason = refusal(context)
    if reason and (run is None or any(obj not in objects for obj in selected_curves(context))):
        labels.sentence(layout, context, reason)
    if (run or not reason) and (unguarded := neighbours.warning(context, objects)):
        labels.sentence(layout, context, unguarded, icon="ERROR")


def _run_buttons(row: bpy.types.UILayout, run: Run) -> None:
    text, icon = ("Resume", "PLAY") if run.state is State.PAUSED else ("Pause", "PAUSE")
    row.operator(CURVE_OT_mobius_flow_pause.bl_idname, text=text, icon=icon)
    row.operator(CURVE_OT_mobius_flow_stop.bl_idname, icon="CHECKMARK")
    row.operator(CURVE_OT_mobius_flow_cancel.bl_idname, icon="X")


def _bake_buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    column = layout.column(align=True)
    row = column.row(align=True)
    row.operator(CURVE_OT_mobius_flow_bake_again.bl_idname, icon="FILE_REFRESH")
    row.operator(CURVE_OT_mobius_flow_continue.bl_idname, icon="FF")
    column.operator(CURVE_OT_mobius_flow_clear.bl_idname, icon="TRASH")
    column.operator(CURVE_OT_mobius_flow_scene_range.bl_idname, icon="PREVIEW_RANGE")
    if hidden := unseen(context.scene, bake.scene_range(selected_curves(context))):
        labels.sentence(layout, context, hidden)


def _progress(layout: bpy.types.UILayout, context: bpy.types.Context, run: Run) -> None:
    """What is known of the run that is going on, or of the last one."""
    box = layout.box().column(align=True)
    _value(box, ", ".join(run.group.names), "Waiting for the render" if run.waits else run.state.value.capitalize())
    if run.last is not None:
        _value(box, "Energy", f"{run.last.energy:.4f}")
        _value(box, "Iteration", f"{run.last.index}")
        _value(box, "Step", f"{run.last.step_size:.3g}")
        proved = run.last.certified if run.report is None else run.report.certified
        whom = "with itself" if len(run.group.names) == 1 else "among themselves"
        _value(box, "Free of contact", whom if proved else "not proved")
    if run.report is not None and run.report.radius is not None:
        _value(box, "Tube radius", f"{run.report.radius:.4g}")
    if run.message:
        labels.sentence(box, context, run.message, icon="ERROR" if run.failed else "INFO")


def _value(layout: bpy.types.UILayout, name: str, text: str) -> None:
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=name)
    split.label(text=text)


def _column(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, *names: str) -> None:
    column = layout.column(align=True)
    for name in names:
        column.prop(settings, name)
