"""The operator that adds knots by name."""

import re

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from ...core import Curve, OptionError
from ...core.messages import Message
from .adding import AddsKnot

_MAX_TURNS = 100  # of a torus knot, or strands of a braid: 50,000 points and a second


class CURVE_OT_mobius_flow_add_knot(AddsKnot, bpy.types.Operator):  # noqa: N801
    """Add a knot or link as it is woven, to be relaxed: a name of the table, a torus knot, a braid or a hard unknot"""

    bl_idname = "curve.mobius_flow_add_knot"
    bl_label = "Knot"

    kind: EnumProperty(
        name="Kind",
        items=[
            ("TABLE", "Name", "A knot or link of the table"),
            ("TORUS", "Torus", "The torus knot or link T(p, q)"),
        ],
        default="TABLE",
    )
    knot: StringProperty(name="Knot", description="Name in the table, such as 3_1 or T(2,5)", default="3_1")
    p: IntProperty(name="p", description="How often the curve goes round the torus", default=2, soft_min=2)
    q: IntProperty(name="q", description="How often the curve goes through the torus", default=3, soft_min=2)

    def make(self) -> tuple[str, Curve]:
        """Make the knot, unless it would freeze the window."""
        from ...core.knots import knot

        name = self.knot if self.kind == "TABLE" else f"T({self.p},{self.q})"
        check_numbers(name)
        return name, knot(name)

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        """Show the name or the torus parameters, not both."""
        layout.prop(self, "kind")
        for name in ("knot",) if self.kind == "TABLE" else ("p", "q"):
            layout.prop(self, name)


def check_numbers(name: str) -> None:
    """Raise an OptionError for a torus knot or braid that would freeze the window."""
    for number in re.findall(r"\d+", "".join(re.findall(r"\([^)]*\)", name))):
        if int(number) > _MAX_TURNS:
            raise OptionError(
                Message(
                    "{name} has a number beyond {most}, which is too much for a window; use smaller ones",
                    name=name[:60],
                    most=_MAX_TURNS,
                )
            )


CLASSES = (CURVE_OT_mobius_flow_add_knot,)
