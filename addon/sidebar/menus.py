"""Entries in Blender's menus."""

import bpy

from ..buttons.add_knot import CURVE_OT_mobius_flow_add_knot


def add_knot(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Offer knots in Add > Curve."""
    menu.layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, icon="CURVE_NCIRCLE")


def register() -> None:
    """Put the entries into the menus."""
    bpy.types.VIEW3D_MT_curve_add.append(add_knot)


def unregister() -> None:
    """Take them out again."""
    bpy.types.VIEW3D_MT_curve_add.remove(add_knot)
