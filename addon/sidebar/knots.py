"""The panel where knots are picked and drawings become knots, and the sub-menu of Add > Curve."""

import bpy

from ...core.messages import Message
from ..buttons.add_family import CURVE_OT_mobius_flow_add_family
from ..buttons.add_knot import CURVE_OT_mobius_flow_add_knot
from ..buttons.draw_knot import CURVE_OT_mobius_flow_draw_knot
from ..buttons.pick_knot import CURVE_OT_mobius_flow_pick_knot
from ..engine.knot_list import COMMON, labels
from ..pictures import icons
from ..translations import iface_
from .layout import InSidebar

_FAMILIES = ("TORUS", "BRAID", "LISSAJOUS", "CABLE", "DOUBLE")


class VIEW3D_PT_mobius_flow_knots(InSidebar, bpy.types.Panel):  # noqa: N801
    """A gallery of knots to add, and the button for drawings."""

    bl_label = "Knots"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012

    def fill(self, layout: bpy.types.UILayout, context: bpy.types.Context, _settings: bpy.types.PropertyGroup) -> None:
        """Put in the gallery and the buttons."""
        picked = context.scene.mobius_flow_knots
        layout.prop(picked, "group")
        layout.template_icon_view(picked, "knot", show_labels=True, scale=7.0, scale_popup=4.0)
        row = layout.row(align=True)
        label = labels().get(picked.knot)
        text = iface_("Add {knot}", knot=Message(label or ""))
        button = row.operator(CURVE_OT_mobius_flow_pick_knot.bl_idname, text=text, icon="ADD")
        button.knot, button.mirror = label or "", picked.mirror
        row.prop(picked, "mirror", text="", icon="MOD_MIRROR")
        search(layout)
        layout.operator(CURVE_OT_mobius_flow_draw_knot.bl_idname, icon="GREASEPENCIL")


class VIEW3D_MT_mobius_flow_knots(bpy.types.Menu):  # noqa: N801
    """Knots to add: common ones, the whole table, and families."""

    bl_label = "Knot"

    def draw(self, _context: bpy.types.Context) -> None:
        """Show common ones with their pictures, then the rest."""
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        for name in COMMON:
            button = layout.operator(
                CURVE_OT_mobius_flow_pick_knot.bl_idname, text=labels()[name], icon_value=icons.icon(name)
            )
            button.knot = labels()[name]
        layout.separator()
        search(layout)
        layout.separator()
        for family in _FAMILIES:
            layout.operator(CURVE_OT_mobius_flow_add_family.bl_idname, text=family.title()).family = family
        layout.separator()
        layout.operator(CURVE_OT_mobius_flow_add_knot.bl_idname, text="By Name, as Woven")
        layout.operator(CURVE_OT_mobius_flow_draw_knot.bl_idname, text="From Drawing")


def search(layout: bpy.types.UILayout) -> None:
    """Offer the list of the whole table."""
    column = layout.column()
    column.operator_context = "INVOKE_DEFAULT"
    column.operator(CURVE_OT_mobius_flow_pick_knot.bl_idname, text="Search...", icon="VIEWZOOM")


CLASSES = (VIEW3D_PT_mobius_flow_knots, VIEW3D_MT_mobius_flow_knots)
