"""Entries in Blender's menus, where Operator Search finds them too."""

from collections.abc import Callable

import bpy

from ..engine.knot_list import COMMON, labels
from ..pictures import icons
from .layout import operator

_FAMILIES = ("TORUS", "BRAID", "LISSAJOUS", "CABLE", "DOUBLE")
_OPERATORS = (
    ("bake_again", "continue", "morph", "clear", "scene_range"),
    ("keep_size", "lay_flat", "face_camera"),
    ("balance", "check", "leave_saddle"),
    ("fit_tube", "color_components"),
    ("pin", "pin_ends", "unpin"),
    ("pack", "close"),
    ("object_mode", "make_local", "single_user", "make_3d", "to_poly", "copy", "to_curve"),
)


class VIEW3D_MT_mobius_flow(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_mobius_flow"
    bl_label = "Möbius Flow"

    def draw(self, _context: bpy.types.Context) -> None:
        """Offer everything; entries that do not apply are grey, and their tooltips say why."""
        self.layout.operator_context = "INVOKE_REGION_WIN"  # or else they do the whole job while Blender waits
        # Operator Search lists this first for those who type no ö
        operator(self.layout, "relax", text="Relax and Untangle (Mobius Flow)", icon="PLAY")
        for group in _OPERATORS:
            self.layout.separator()
            for name in group:
                operator(self.layout, name)


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
        for family in _FAMILIES:
            operator(layout, "add_family", text=family.title()).family = family
        layout.separator()
        operator(layout, "add_knot", text="By Name, as Woven")
        operator(layout, "draw_knot", text="From Drawing")


def search(layout: bpy.types.UILayout, _context: bpy.types.Context) -> None:
    column = layout.column()
    column.operator_context = "INVOKE_DEFAULT"
    operator(column, "pick_knot", text="Search...", icon="VIEWZOOM")


def _flow(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.separator()
    menu.layout.menu(VIEW3D_MT_mobius_flow.bl_idname)


_ENTRIES: dict[str, Callable[[bpy.types.Menu, bpy.types.Context], None]] = {
    "VIEW3D_MT_curve_add": lambda menu, _: menu.layout.menu(VIEW3D_MT_mobius_flow_knots.__name__, icon="CURVE_NCIRCLE"),
    "VIEW3D_MT_object": _flow,
    "VIEW3D_MT_edit_curve": _flow,
}


def register() -> None:
    for menu, entry in _ENTRIES.items():
        getattr(bpy.types, menu).append(entry)


def unregister() -> None:
    for menu, entry in _ENTRIES.items():
        getattr(bpy.types, menu).remove(entry)
