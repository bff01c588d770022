"""The operator that adds knots of families: a few numbers make each."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ...core import Curve, knots
from ..engine.knot_list import labels, name_of
from .adding import AddsKnot, found, named_knot

_SHOWN = {
    "TORUS": ("p", "q"),
    "BRAID": ("word",),
    "LISSAJOUS": ("frequency_x", "frequency_y", "frequency_z", "phase_x", "phase_y"),
    "CABLE": ("companion", "strands", "turns"),
    "DOUBLE": ("companion", "twists", "left_clasp"),
}


class CURVE_OT_mobius_flow_add_family(AddsKnot, bpy.types.Operator):
    """Add a knot or link made by a few numbers: a torus knot, braid, Lissajous curve, or two strands along a knot"""

    bl_label = "Knot Family"

    family: EnumProperty(
        name="Family",
        description="What makes the knot",
        items=[
            ("TORUS", "Torus", "Winds around a torus"),
            ("BRAID", "Braid", "Strands that cross one by one and close in a circle"),
            ("LISSAJOUS", "Lissajous", "Three oscillations at right angles"),
            ("CABLE", "Cable", "Strands along a knot, wound around each other"),
            ("DOUBLE", "Double", "Two strands along a knot that hook into each other"),
        ],
        default="TORUS",
    )
    p: IntProperty(name="p", description="How often the curve goes round the torus", default=3, soft_min=2)
    q: IntProperty(name="q", description="How often the curve goes through the torus", default=4, soft_min=2)
    word: StringProperty(
        name="Braid",
        description="Crossings one by one: 2 crosses strands 2 and 3, -2 does so the other way",
        default="1 -2 1 -2 1 -2",
    )
    frequency_x: IntProperty(name="Frequency X", description="Oscillations along X", default=3, min=1, max=40)
    frequency_y: IntProperty(name="Y", description="Oscillations along Y", default=4, min=1, max=40)
    frequency_z: IntProperty(name="Z", description="Oscillations along Z", default=7, min=1, max=40)
    phase_x: FloatProperty(
        name="Phase X", description="Where the oscillation along X begins", default=0.7, subtype="ANGLE"
    )
    phase_y: FloatProperty(name="Y", description="Where the oscillation along Y begins", default=0.2, subtype="ANGLE")
    companion: StringProperty(
        name="Along", description="Knot that the strands follow", default=labels()["3_1"], search=found
    )
    strands: IntProperty(name="Strands", description="Number of strands along the knot", default=2, min=2, max=12)
    turns: IntProperty(
        name="Turns",
        description="Steps from strand to strand around the knot; one curve if Strands has no common divisor with it",
        default=1,
        min=-100,
        max=100,
    )
    twists: IntProperty(
        name="Twists", description="Full turns of the two strands around each other", default=0, min=-100, max=100
    )
    left_clasp: BoolProperty(
        name="Left-Handed Clasp", description="Hook the strands into each other the other way", default=False
    )

    def make(self) -> tuple[str, Curve]:
        if self.family == "TORUS":
            return named_knot(f"T({self.p},{self.q})")
        if self.family == "BRAID":
            return named_knot(f"braid({','.join(self.word.replace(',', ' ').split())})")
        if self.family == "LISSAJOUS":
            frequencies, phases = (self.frequency_x, self.frequency_y, self.frequency_z), (self.phase_x, self.phase_y)
            return f"Lissajous{frequencies}".replace(" ", ""), knots.lissajous_knot(frequencies, phases)
        name = name_of(self.companion)
        along = knots.smooth_knot(name)
        if self.family == "CABLE":
            return f"Cable({self.strands},{self.turns}) of {name}", knots.cable(along, self.strands, self.turns)
        return f"Double of {name}", knots.double(along, self.twists, clasp=-1 if self.left_clasp else 1)

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        layout.prop(self, "family")
        column = layout.column(align=True)
        for name in _SHOWN[self.family]:
            column.prop(self, name)
