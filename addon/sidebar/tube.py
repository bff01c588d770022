"""The sub-panel for the tubes around curves, their colors, and what can be made of them."""

import bpy

from ...core.messages import Message
from ..buttons.outputs import CURVE_OT_mobius_flow_smooth_curve, CURVE_OT_mobius_flow_tube_mesh
from ..buttons.tube import CURVE_OT_mobius_flow_color_components, CURVE_OT_mobius_flow_fit_tube
from ..curves import bevel
from ..curves.exchange import stretch
from ..curves.units import length
from ..live.checks import selected_curves
from .layout import InSidebar, value


class VIEW3D_PT_mobius_flow_tube(InSidebar, bpy.types.Panel):  # noqa: N801
    """How thick the curves are drawn, what is fitted, and the buttons."""

    bl_label = "Tube"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - read by Blender

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put them in."""
        for obj in selected_curves(context)[:1]:
            value(layout, "Radius", _radius(context.scene, obj))
        column = layout.column(align=True)
        column.operator(CURVE_OT_mobius_flow_fit_tube.bl_idname, icon="MESH_CYLINDER")
        column.operator(CURVE_OT_mobius_flow_color_components.bl_idname, icon="COLOR")
        layout.prop(settings, "fit_bevel")
        column = layout.column(align=True)
        column.operator(CURVE_OT_mobius_flow_tube_mesh.bl_idname, icon="OUTLINER_OB_MESH")
        column.operator(CURVE_OT_mobius_flow_smooth_curve.bl_idname, icon="CURVE_BEZCURVE")


def _radius(scene: bpy.types.Scene, obj: bpy.types.Object) -> Message:
    """The radius of an object's tube, and whose it is."""
    depth = obj.data.bevel_depth
    if not depth:
        return Message("None")
    radius = length(scene, depth * stretch(obj))
    fitted = bevel.is_fitted(obj.data)
    return Message("{radius} (fitted)", radius=radius) if fitted else Message("{radius} (your own)", radius=radius)


CLASSES = (VIEW3D_PT_mobius_flow_tube,)
