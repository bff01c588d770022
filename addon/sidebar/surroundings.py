"""The sub-panel for what is around the curves, and the warning of what might be crossed."""

from collections.abc import Sequence

import bpy

from ...core.messages import Message
from ..buttons.avoiding import CURVE_OT_mobius_flow_avoid
from ..curves import neighbours
from ..curves.standing import unsteady
from ..engine.words import named
from ..live.avoided import avoided
from ..live.checks import selected_curves
from .labels import sentence
from .layout import InSidebar


class VIEW3D_PT_mobius_flow_surroundings(InSidebar, bpy.types.Panel):  # noqa: N801 - Blender's naming scheme
    """What is around the curves that are relaxed."""

    bl_label = "Surroundings"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - read by Blender

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, _settings: bpy.types.PropertyGroup) -> None:
        """Put in the collection to avoid, and what it comes to."""
        surroundings = context.scene.mobius_flow_surroundings
        layout.prop(surroundings, "avoid")
        if surroundings.avoid is None:
            return
        found = avoided(context)
        if not found:
            sentence(layout, context, Message("Nothing in it is visible"))
        elif not unsteady(found, selected_curves(context)):
            names = named([obj.name for obj in found])
            sentence(layout, context, Message("Curves never touch {names}", names=names))


def warned(layout: bpy.types.UILayout, context: bpy.types.Context, objects: Sequence[bpy.types.Object]) -> None:
    """Say what cannot be avoided, or else what might be crossed, with the button that helps."""
    found = avoided(context)
    if moving := unsteady(found, selected_curves(context)):
        sentence(layout, context, moving, icon="ERROR")
    elif unguarded := neighbours.warning(context, objects, found):
        sentence(layout, context, unguarded, icon="ERROR")
        layout.operator(CURVE_OT_mobius_flow_avoid.bl_idname, icon="ADD")


CLASSES = (VIEW3D_PT_mobius_flow_surroundings,)
