"""The sub-panel for the shape of a relaxed curve."""

import bpy

from ...core.messages import Message
from ..buttons.resting import (
    CURVE_OT_mobius_flow_balance,
    CURVE_OT_mobius_flow_check,
    CURVE_OT_mobius_flow_leave_saddle,
)
from ..buttons.shape import (
    CURVE_OT_mobius_flow_face_camera,
    CURVE_OT_mobius_flow_keep_size,
    CURVE_OT_mobius_flow_lay_flat,
)
from ..engine.size import Measure
from ..translations import iface_
from .layout import InSidebar, settings_column


class VIEW3D_PT_mobius_flow_shape(InSidebar, bpy.types.Panel):  # noqa: N801
    """What a relaxed curve looks like: its size while it moves, how it lies, which of equally good shapes it has."""

    bl_label = "Shape"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012

    def fill(self, layout: bpy.types.UILayout, _context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in buttons, those that belong together in one row, and what is kept while curves move."""
        settings_column(layout, settings, "keep_size")
        column = layout.column(align=True)
        text = iface_("Keep {measure}", measure=Message(Measure[settings.keep_size].value))
        keep = column.operator(CURVE_OT_mobius_flow_keep_size.bl_idname, text=text, icon="FULLSCREEN_EXIT")
        keep.measure = settings.keep_size
        row = column.row(align=True)
        row.operator(CURVE_OT_mobius_flow_lay_flat.bl_idname, icon="AXIS_TOP")
        row.operator(CURVE_OT_mobius_flow_face_camera.bl_idname, icon="CAMERA_DATA")
        column = layout.column(align=True)
        column.operator(CURVE_OT_mobius_flow_balance.bl_idname, icon="MOD_CURVE")
        row = column.row(align=True)
        row.operator(CURVE_OT_mobius_flow_check.bl_idname, icon="VIEWZOOM")
        row.operator(CURVE_OT_mobius_flow_leave_saddle.bl_idname, icon="SORT_ASC")


CLASSES = (VIEW3D_PT_mobius_flow_shape,)
