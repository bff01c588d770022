"""Entries in Blender's menus."""

import bpy

from .knots import VIEW3D_MT_mobius_flow_knots


def add_knot(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Offer knots in Add > Curve."""
    menu.layout.menu(VIEW3D_MT_mobius_flow_knots.__name__, icon="CURVE_NCIRCLE")


def register() -> None:
    """Put the entries into the menus."""
    bpy.types.VIEW3D_MT_curve_add.append(add_knot)


def unregister() -> None:
    """Take them out again."""
    bpy.types.VIEW3D_MT_curve_add.remove(add_knot)
