"""The sub-panel for films."""

import bpy

from ..buttons.baking import CURVE_OT_mobius_flow_scene_range
from ..buttons.film import (
    CURVE_OT_mobius_flow_remove_stage,
    CURVE_OT_mobius_flow_render_film,
    CURVE_OT_mobius_flow_set_up_stage,
)
from ..pictures import staging
from ..translations import iface_
from .labels import sentence
from .layout import InSidebar, settings_column


class VIEW3D_PT_mobius_flow_film(InSidebar, bpy.types.Panel):  # noqa: N801
    """The stage, what is rendered of the scene, and where the film goes."""

    bl_label = "Film"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - read by Blender

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, _settings: bpy.types.PropertyGroup) -> None:
        """Put in buttons, and Blender's own settings beside ours."""
        scene = context.scene
        row = layout.row(align=True)
        row.operator(CURVE_OT_mobius_flow_set_up_stage.bl_idname, icon="OUTLINER_OB_LIGHT")
        if staging.own_stage(scene):
            row.operator(CURVE_OT_mobius_flow_remove_stage.bl_idname, text="", icon="X")
        if not staging.fits(scene):
            sentence(layout, context, "The picture has another shape than the stage's camera; press Set Up Stage again")
        column = layout.column(align=True)
        column.prop(scene.render, "resolution_x", text=iface_("Resolution X"))
        column.prop(scene.render, "resolution_y", text="Y")
        column.prop(scene.render, "resolution_percentage", text="%")
        column = layout.column(align=True)
        column.prop(scene, "frame_start", text=iface_("Frame Start"))
        column.prop(scene, "frame_end", text=iface_("End"))
        column.operator(CURVE_OT_mobius_flow_scene_range.bl_idname, icon="PREVIEW_RANGE")
        settings_column(layout, scene.mobius_flow_film, "look", "filepath")
        layout.operator(CURVE_OT_mobius_flow_render_film.bl_idname, icon="RENDER_ANIMATION")


CLASSES = (VIEW3D_PT_mobius_flow_film,)
