"""What can be done with the tubes around curves: fit them, and give each component a color."""

import bpy

from ..curves.fitting import fit_tubes
from ..live.checks import selected_curves, unfitting, unpaintable
from ..live.refusal import Refusal
from ..pictures.materials import colour_components
from .refusing import Refusing


class CURVE_OT_mobius_flow_fit_tube(Refusing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Draw the selected curves as the thickest round tubes that do not touch. Relaxing keeps them so"""

    bl_idname = "curve.mobius_flow_fit_tube"
    bl_label = "Fit Tube"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """The curves' profiles must be plain."""
        return unfitting(context)

    def act(self, context: bpy.types.Context) -> None:
        """Fit them."""
        fit_tubes(selected_curves(context))


class CURVE_OT_mobius_flow_color_components(Refusing, bpy.types.Operator):  # noqa: N801
    """Give each spline of the selected objects a material of its own, in slots after those that are there"""

    bl_idname = "curve.mobius_flow_color_components"
    bl_label = "Color Components"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """The curves' data must be their own."""
        return unpaintable(context)

    def act(self, context: bpy.types.Context) -> None:
        """Number the components through all objects."""
        first = 0
        for obj in selected_curves(context):
            colour_components(obj.data, first)
            first += len(obj.data.splines)


CLASSES = (CURVE_OT_mobius_flow_fit_tube, CURVE_OT_mobius_flow_color_components)
