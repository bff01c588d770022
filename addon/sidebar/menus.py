"""Entries in Blender's menus, where Operator Search finds them too."""

from collections.abc import Callable

import bpy

from ..pictures import icons
from ..pictures.icons import COMMON, labels
from .layout import operator

_OPERATORS = (
    ("bake_again", "continue", "morph", "clear", "scene_range"),
    ("fit_tube", "color_components"),
    ("keep_size", "lay_flat", "face_camera"),
    ("pin", "unpin", "pack", "separate", "tighten"),
)


class VIEW3D_MT_mobius_flow(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_mobius_flow"
    bl_label = "Möbius Flow"

    def draw(self, _context: bpy.types.Context) -> None:
        """Offer everything; entries that do not apply are grey, and their tooltips say why."""
        self.layout.operator_context = "INVOKE_REGION_WIN"  # or else they do the whole job while Blender waits
        # Operator Search lists this first for those who type no ö; "(Mobius" would not begin with what they type
        operator(self.layout, "relax", text="Relax and Untangle - Mobius Flow", icon="PLAY")
        for group in _OPERATORS:
            self.layout.separator()
            for name in group:
                operator(self.layout, name)
        self.layout.operator_menu_enum("curve.mobius_flow_mend", "remedy")


class VIEW3D_MT_mobius_flow_knots(bpy.types.Menu):
    bl_label = "Knot"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        for name in COMMON:
            label = labels()[name]
            operator(layout, "pick_knot", text=label, icon_value=icons.icon(name)).knot = label
        layout.separator()
        search(layout, context)
        layout.separator()
        for family in ("TORUS", "BRAID", "LISSAJOUS", "CABLE", "DOUBLE"):
            operator(layout, "add_knot", text=family.title()).kind = family
        layout.separator()
        operator(layout, "add_knot", text="By Name, as Woven").kind = "TABLE"
        operator(layout, "draw_knot", text="From Drawing")


def search(layout: bpy.types.UILayout, _context: bpy.types.Context) -> None:
    column = layout.column()
    column.operator_context = "INVOKE_DEFAULT"
    operator(column, "pick_knot", text="Search...", icon="VIEWZOOM")


def _flow(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.separator()
    menu.layout.menu(VIEW3D_MT_mobius_flow.bl_idname)


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


_ENTRIES: dict[str, Callable[[bpy.types.Menu, bpy.types.Context], None]] = {
    "VIEW3D_MT_curve_add": lambda menu, _: menu.layout.menu(VIEW3D_MT_mobius_flow_knots.__name__, icon="CURVE_NCIRCLE"),
    "VIEW3D_MT_object": _flow,
    "VIEW3D_MT_edit_curve": _flow,
}


def register() -> None:
    for menu, entry in _ENTRIES.items():
        getattr(bpy.types, menu).append(entry)
    bpy.utils.register_tool(KnotTool, separator=True)


def unregister() -> None:
    bpy.utils.unregister_tool(KnotTool)
    for menu, entry in _ENTRIES.items():
        getattr(bpy.types, menu).remove(entry)
