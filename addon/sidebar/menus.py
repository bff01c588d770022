"""Entries in Blender's menus, where Operator Search finds them too."""

from collections.abc import Callable

import bpy

from ..buttons import baking, closing, mending, pinning, resting, shape, tube
from ..buttons.relaxing import CURVE_OT_mobius_flow_relax
from .knots import VIEW3D_MT_mobius_flow_knots


class VIEW3D_MT_mobius_flow(bpy.types.Menu):  # noqa: N801 - Blender's naming scheme
    """All that can be done with curves that are there"""

    bl_idname = "VIEW3D_MT_mobius_flow"
    bl_label = "Möbius Flow"

    def draw(self, _context: bpy.types.Context) -> None:
        """Offer it all; what does not apply is grey, and its tooltip says why."""
        # Operator Search lists this first for who types no ö
        self.layout.operator(CURVE_OT_mobius_flow_relax.bl_idname, text="Relax by Mobius Energy", icon="PLAY")
        for group in (baking, shape, resting, tube, pinning, closing, mending):
            self.layout.separator()
            for cls in group.CLASSES:
                self.layout.operator(cls.bl_idname)


def add_knot(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Offer knots in Add > Curve."""
    menu.layout.menu(VIEW3D_MT_mobius_flow_knots.__name__, icon="CURVE_NCIRCLE")


def flow(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    """Offer the rest in Object, and in Edit Mode in Curve."""
    menu.layout.separator()
    menu.layout.menu(VIEW3D_MT_mobius_flow.bl_idname)


_ENTRIES: dict[str, Callable[[bpy.types.Menu, bpy.types.Context], None]] = {
    "VIEW3D_MT_curve_add": add_knot,
    "VIEW3D_MT_object": flow,
    "VIEW3D_MT_edit_curve": flow,
}
CLASSES = (VIEW3D_MT_mobius_flow,)


def register() -> None:
    """Put the entries into the menus."""
    for menu, entry in _ENTRIES.items():
        getattr(bpy.types, menu).append(entry)


def unregister() -> None:
    """Take them out again."""
    for menu, entry in _ENTRIES.items():
        getattr(bpy.types, menu).remove(entry)
