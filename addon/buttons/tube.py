"""What can be done with the tubes around curves: fit them, and give each component a color."""

import bpy

from ...core import MobiusFlowError
from ..curves.fitting import fit_tubes
from ..live.checks import selected_curves, unfitting, unpaintable
from ..pictures.materials import colour_components


class CURVE_OT_mobius_flow_fit_tube(bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Draw the selected curves as the thickest round tubes that do not touch. Relaxing keeps them so"""

    bl_idname = "curve.mobius_flow_fit_tube"
    bl_label = "Fit Tube"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether tubes can be fitted; the tooltip says why not."""
        reason = unfitting(context)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Fit them."""
        context.view_layer.update()  # a script may have moved an object just before
        try:
            fit_tubes(selected_curves(context))
        except MobiusFlowError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class CURVE_OT_mobius_flow_color_components(bpy.types.Operator):  # noqa: N801
    """Give each closed curve of the selected objects a material of its own, in slots after those that are there"""

    bl_idname = "curve.mobius_flow_color_components"
    bl_label = "Color Components"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether materials can be given."""
        reason = unpaintable(context)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Number the components through all objects."""
        first = 0
        for obj in selected_curves(context):
            colour_components(obj.data, first)
            first += len(obj.data.splines)
        return {"FINISHED"}


CLASSES = (CURVE_OT_mobius_flow_fit_tube, CURVE_OT_mobius_flow_color_components)
