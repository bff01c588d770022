"""The operator that adds knots of the table in their smooth shapes, picked from a list."""

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ...core import Curve
from ..engine.knot_list import labels, name_of
from .adding import AddsKnot


def found(_operator: bpy.types.Operator, _context: bpy.types.Context, _text: str) -> list[str]:
    """All labels; Blender shows those that match what is typed."""
    return list(labels().values())


class CURVE_OT_mobius_flow_pick_knot(AddsKnot, bpy.types.Operator):  # noqa: N801
    """Add a knot or link of the table, smooth, lying flat, with evenly spread strands; Relax lowers its energy"""

    bl_idname = "curve.mobius_flow_pick_knot"
    bl_label = "Search Knot"
    bl_property = "choice"  # what the list of the popup is about

    knot: StringProperty(
        name="Knot",
        description="Name in the table, from 0_1 to 10_165, or of a link such as L2a1",
        default=labels()["3_1"],
        search=found,
    )
    choice: EnumProperty(
        name="Knot",
        description="Knot picked from the list",
        items=[(name, label, "") for name, label in labels().items()],
        options={"HIDDEN", "SKIP_SAVE"},
    )
    mirror: BoolProperty(
        name="Mirror", description="Make the mirror image: every crossing changes over into under", default=False
    )
    vertices: IntProperty(
        name="Points",
        description="Number of points, 0 for as many as look smooth",
        default=0,
        min=0,
        max=20_000,
        soft_max=2000,
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask which one, unless it was given."""
        if self.properties.is_property_set("knot"):
            return self.execute(context)
        context.window_manager.invoke_search_popup(self)
        return {"FINISHED"}

    def make(self) -> tuple[str, Curve]:
        """Look the shape up."""
        from ...core.knots import smooth_knot

        if self.properties.is_property_set("choice"):
            self.knot = labels()[self.choice]
            self.properties.property_unset("choice")  # from now on the name is what counts
        name = ("m" if self.mirror else "") + name_of(self.knot)
        return name, smooth_knot(name, self.vertices or None)

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        """Show the name and what is done with it."""
        for name in ("knot", "mirror", "vertices"):
            layout.prop(self, name)


CLASSES = (CURVE_OT_mobius_flow_pick_knot,)
