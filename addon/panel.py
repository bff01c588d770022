"""The sidebar panel and the entry in the Add menu."""

import textwrap

import bpy

from .checks import refusal
from .operators import CURVE_OT_mobius_flow_add_knot, CURVE_OT_mobius_flow_relax


class VIEW3D_PT_mobius_flow(bpy.types.Panel):  # noqa: N801 - Blender's naming scheme
    """Settings and the Relax button; when it is disabled, the reason stands below it."""

    bl_label = "Möbius Flow"
    bl_category = "Möbius Flow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        """Lay the panel out."""
        layout = self.layout
        settings = context.scene.mobius_flow
        layout.use_property_split = True
        layout.use_property_decorate = False
        _column(layout, settings, "method", "tolerance", "max_iterations", "vertices")
        _column(layout, settings, "keyframes")
        if settings.keyframes != "RESULT":
            _column(layout, settings, "start_frame", "frames_per_iterate", "max_keys")
        layout.operator(CURVE_OT_mobius_flow_relax.bl_idname, icon="CURVE_NCIRCLE")
        reason = refusal(context)
        if reason:
            _lines(layout, reason)
        layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, text="Add Knot", icon="ADD")


def add_menu_entry(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Offer knots in Add > Curve."""
    menu.layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, icon="CURVE_NCIRCLE")


def _column(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, *names: str) -> None:
    column = layout.column(align=True)
    for name in names:
        column.prop(settings, name)


def _lines(layout: bpy.types.UILayout, sentence: str, width: int = 38) -> None:
    """Labels do not wrap by themselves."""
    column = layout.column(align=True)
    for k, line in enumerate(textwrap.wrap(sentence, width)):
        column.label(text=line, icon="NONE" if k else "INFO")
