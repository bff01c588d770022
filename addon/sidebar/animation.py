"""The sub-panel for what is kept of the motion."""

import bpy

from ..buttons.baking import (
    CURVE_OT_mobius_flow_bake_again,
    CURVE_OT_mobius_flow_clear,
    CURVE_OT_mobius_flow_continue,
    CURVE_OT_mobius_flow_scene_range,
)
from ..curves import bake
from ..engine.key_options import Output
from ..engine.timing import Pace
from ..live.checks import selected_curves
from ..live.start import unseen
from .labels import sentence
from .layout import InSidebar, settings_column


class VIEW3D_PT_mobius_flow_animation(InSidebar, bpy.types.Panel):  # noqa: N801
    """How the motion is kept as keyframes, and what can be done with them afterwards."""

    bl_label = "Animation"
    bl_parent_id = "VIEW3D_PT_mobius_flow"

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in buttons for curves that were baked, then settings."""
        _bake_buttons(layout, context)
        animated = settings.keyframes != Output.RESULT.name
        if animated:
            lasting = "frames_per_iterate" if settings.timing == Pace.ITERATE.name else "length"
            settings_column(layout, settings, "timing", lasting, "start_frame", "hold_start", "hold_end")
        settings_column(layout, settings, "keyframes", *(["max_keys"] if animated else []))


def _bake_buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    column = layout.column(align=True)
    row = column.row(align=True)
    row.operator(CURVE_OT_mobius_flow_bake_again.bl_idname, icon="FILE_REFRESH")
    row.operator(CURVE_OT_mobius_flow_continue.bl_idname, icon="FF")
    column.operator(CURVE_OT_mobius_flow_clear.bl_idname, icon="TRASH")
    column.operator(CURVE_OT_mobius_flow_scene_range.bl_idname, icon="PREVIEW_RANGE")
    if hidden := unseen(context.scene, bake.scene_range(selected_curves(context))):
        sentence(layout, context, hidden)


CLASSES = (VIEW3D_PT_mobius_flow_animation,)
