"""The sub-panel for those who know the mathematics."""

import bpy

from ..properties import shown
from .layout import InSidebar, settings_column


class VIEW3D_PT_mobius_flow_expert(InSidebar, bpy.types.Panel):  # noqa: N801
    """Every option of the core, of which Quality and presets set some, and how often the view is updated."""

    bl_label = "Expert"
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - read by Blender

    def fill(self, layout: bpy.types.UILayout, _context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put them all in."""
        for group in ("basic", "advanced"):
            settings_column(layout, settings, *(option.name for option in shown(group)))
        settings_column(layout, settings, "view_every")


CLASSES = (VIEW3D_PT_mobius_flow_expert,)
