"""The tool in the toolbar that draws knots."""

import bpy


class KnotTool(bpy.types.WorkSpaceTool):
    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = "mobius_flow.knot"
    bl_label = "Knot"
    bl_description = "Draw a stroke, which becomes a knot; click a crossing to swap its strands; Enter relaxes"
    bl_icon = "ops.curve.draw"
    bl_keymap = (
        ("curve.mobius_flow_stroke", {"type": "LEFTMOUSE", "value": "PRESS"}, None),
        ("curve.mobius_flow_relax", {"type": "RET", "value": "PRESS"}, None),
    )


def register() -> None:
    bpy.utils.register_tool(KnotTool, separator=True)


def unregister() -> None:
    bpy.utils.unregister_tool(KnotTool)
