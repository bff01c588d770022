"""The sub-panel for points that stay where they are, and for ends."""

import bpy

from ..buttons.closing import CURVE_OT_mobius_flow_close
from ..buttons.pinning import (
    CURVE_OT_mobius_flow_pin,
    CURVE_OT_mobius_flow_pin_ends,
    CURVE_OT_mobius_flow_unpin,
)
from ..curves import pins
from ..live.checks import curves_at_hand
from ..translations import iface_
from .layout import InSidebar, settings_column


class VIEW3D_PT_mobius_flow_pins(InSidebar, bpy.types.Panel):  # noqa: N801 - Blender's naming scheme
    """Points that are held, how many there are, and what becomes of ends."""

    bl_label = "Pins"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - read by Blender

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in the buttons, the number of pins, and the settings."""
        column = layout.column(align=True)
        column.operator(CURVE_OT_mobius_flow_pin.bl_idname, icon="PINNED")
        row = column.row(align=True)
        row.operator(CURVE_OT_mobius_flow_pin_ends.bl_idname, icon="PINNED")
        row.operator(CURVE_OT_mobius_flow_unpin.bl_idname, icon="UNPINNED")
        count = sum(pins.count(obj.data) for obj in curves_at_hand(context))
        if count:
            layout.label(text=iface_("{count} points pinned", count=count), icon="INFO", translate=False)
        settings_column(layout, settings, "pin_tangents")
        layout.operator(CURVE_OT_mobius_flow_close.bl_idname, icon="CURVE_BEZCIRCLE")


CLASSES = (VIEW3D_PT_mobius_flow_pins,)
