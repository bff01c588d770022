"""What panels of the sidebar are made of."""

import bpy

from ..translations import iface_


class InSidebar:
    """A panel in our tab of the sidebar, with the names of settings before them."""

    bl_category = "Möbius Flow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    layout: bpy.types.UILayout

    def draw(self, context: bpy.types.Context) -> None:
        """Lay the panel out."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.fill(self.layout, context, context.scene.mobius_flow)

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, settings: bpy.types.PropertyGroup) -> None:
        """Put in what the panel is for."""
        raise NotImplementedError


def value(layout: bpy.types.UILayout, name: str, text: str) -> None:
    """Show a name and what it is, in the user's language."""
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=iface_(name), translate=False)
    split.label(text=iface_(text), translate=False)


def settings_column(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, *names: str) -> None:
    """Show settings one below the other."""
    column = layout.column(align=True)
    for name in names:
        column.prop(settings, name)
