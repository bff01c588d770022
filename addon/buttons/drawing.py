"""Operators that lift drawings into knots, and operators that add knots from families given by a few numbers."""

import bpy
import numpy as np
from bpy.props import BoolProperty, BoolVectorProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.object_utils import object_data_add

from ...core import Curve, knots
from ...core.knots import Drawing, knot_type
from ...core.messages import Message
from ...core.types import FloatArray
from ..curves.exchange import read_link
from ..engine.knot_list import labels, name_of
from ..engine.placement import DrawingPlane
from ..live.requirements import Condition, selected_curves
from ..translations import iface_, rpt_
from .adding import OBJECT_MODE, AddsKnot, found, named_knot

_DRAWN = Condition("Draw a flat curve and select it first", lambda context: not selected_curves(context))
_SWITCHES = 32  # Blender's longest array of switches
_SHOWN = {
    "TORUS": ("p", "q"),
    "BRAID": ("word",),
    "LISSAJOUS": ("frequency_x", "frequency_y", "frequency_z", "phase_x", "phase_y"),
    "CABLE": ("companion", "strands", "turns"),
    "DOUBLE": ("companion", "twists", "left_clasp"),
}


class DrawsKnot(AddsKnot):
    """An operator that lifts a drawing into a knot, and adds it where it was drawn."""

    def add(self, context: bpy.types.Context, plane: DrawingPlane, lifted: Curve, crossings: int) -> FloatArray:
        """Add a knot that was lifted from a plane, report its type, and return where its object is."""
        vertices, (name, said) = plane.raised(lifted.vertices), described(lifted, crossings)
        middle = vertices.mean(axis=0)
        obj = object_data_add(context, self.curve_data(name, vertices - middle, lifted))
        obj.location, obj.rotation_euler = middle, (0.0, 0.0, 0.0)
        self.report({"INFO"}, rpt_(said))
        return np.asarray(middle)


class CURVE_OT_mobius_flow_draw_knot(DrawsKnot, bpy.types.Operator):
    """Make a knot of the selected flat drawing: where strands cross, one goes over the other; the drawing stays"""

    bl_label = "Knot from Drawing"
    needs = (OBJECT_MODE, _DRAWN)

    change: BoolVectorProperty(
        name="Change Crossings",
        description="Swap over and under at a crossing; they are numbered along the curve",
        size=_SWITCHES,
        default=(False,) * _SWITCHES,
        options={"SKIP_SAVE"},
    )
    mirror: BoolProperty(name="Mirror", description="Swap over and under at all crossings", default=False)
    height: FloatProperty(
        name="Height",
        description="How far strands go over and under; 1 for what looks right in the space there",
        default=1.0,
        min=0.01,
        soft_max=3.0,
        max=100.0,
    )
    number: BoolProperty(
        name="Number Crossings", description="Mark each crossing by an empty that shows its number", default=False
    )
    hide_drawing: BoolProperty(
        name="Hide Drawing", description="Hide the curves that were drawn, in renders too", default=True
    )
    count: IntProperty(name="Crossings", description="Number of crossings found", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: bpy.types.Context) -> None:
        """Lift the drawing and add it as a new object."""
        drawn = selected_curves(context)
        self.check_lengths()
        # the drawing in world space; open splines, such as strokes, are closed by their chords
        curve = Curve.from_components(read_link(drawn)[0].components)
        plane = DrawingPlane.of(curve)
        drawing = Drawing.of(plane.flattened(curve))
        lifted = self._lifted(drawing)
        self.count = len(drawing.crossings)
        middle = self.add(context, plane, lifted, self.count)
        if self.number:
            places = np.column_stack([drawing.crossings, np.zeros(self.count)])
            size = 0.03 * float(np.ptp(lifted.vertices))
            _mark(context.collection, context.object, plane.raised(places) - middle, size)
        for obj in drawn if self.hide_drawing else ():
            obj.hide_set(True)
            obj.hide_render = True

    def _lifted(self, drawing: Drawing) -> Curve:
        count = min(len(drawing.crossings), _SWITCHES)
        lifted = drawing.lifted([k + 1 for k in range(count) if self.change[k]])
        return lifted.with_vertices(lifted.vertices * [1.0, 1.0, -self.height if self.mirror else self.height])

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.label(text=iface_("Change Crossings (1 to {count})", count=min(self.count, _SWITCHES)))
        grid = layout.grid_flow(row_major=True, columns=8, even_columns=True, align=True)
        for k in range(min(self.count, _SWITCHES)):
            grid.prop(self, "change", index=k, text=str(k + 1), toggle=True)
        layout.use_property_split = True
        for name in ("mirror", "height", "number", "hide_drawing", "color_components"):
            layout.prop(self, name)
        self.draw_tube(layout)


def described(curve: Curve, crossings: int) -> tuple[str, Message]:
    """A name for a drawn knot, and a description of it."""
    found = knot_type(curve)
    said = Message("{count} crossings", count=crossings) if crossings != 1 else Message("1 crossing")
    if found.proved and found.names == ("0_1",):
        return "Drawn Unknot", Message("{crossings}: it is not knotted", crossings=said)
    if not found.names:
        return "Drawn Knot", said
    known = Message("one of {knots}", knots=", ".join(found.names)) if len(found.names) > 1 else found.names[0]
    name = "Drawn Knot" if len(found.names) > 1 else f"Drawn {found.names[0]}"
    sentence = "{crossings}: {knots}, proved" if found.proved else "{crossings}: perhaps {knots}, not proved"
    return name, Message(sentence, crossings=said, knots=known)


def _mark(collection: bpy.types.Collection, parent: bpy.types.Object, places: FloatArray, size: float) -> None:
    for number, place in enumerate(places, 1):
        empty = bpy.data.objects.new(str(number), None)
        empty.empty_display_size, empty.show_name, empty.show_in_front = size, True, True
        empty.parent, empty.location = parent, place
        collection.objects.link(empty)


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
