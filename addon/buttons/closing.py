"""The button that closes open splines, for those who want knots."""

import bpy

from ...core.messages import Message
from ..curves.mending import close
from ..live.checks import closable, running, selected_curves
from ..live.refusal import Refusal
from .refusing import Refusing


class CURVE_OT_mobius_flow_close(Refusing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Join the two ends of every open spline of the selected curves"""

    bl_idname = "curve.mobius_flow_close"
    bl_label = "Close Splines"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Some must be open, and not be keyed so."""
        if refused := running():
            return refused
        if any(closable(selected_curves(context))):
            return None
        return Refusal(Message("No selected curve has an open spline without keys; select one in Object Mode"))

    def act(self, context: bpy.types.Context) -> None:
        """Close them."""
        for obj in closable(selected_curves(context)):
            close(obj)


CLASSES = (CURVE_OT_mobius_flow_close,)
