"""Operators that add knots by name, woven or smooth, and the base of all operators that add knots."""

import re
from collections.abc import Sequence

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from ...core import Curve, OptionError, knots
from ...core.base import FloatArray, Message
from ..curves import bevel
from ..curves.splines import box, new_curve_data, write_points
from ..live.requirements import Condition
from ..pictures.icons import labels, name_of
from ..pictures.materials import colour_components
from .button import Button

OBJECT_MODE = Condition("Go back to Object Mode first", lambda context: context.mode != "OBJECT")
_OSCILLATIONS = ("frequency_x", "frequency_y", "frequency_z", "phase_x", "phase_y")
_KINDS = {  # what makes a knot: its title, its description, and the settings it has
    "TABLE": ("Name", "A knot or link of the table", ("knot",)),
    "TORUS": ("Torus", "The torus knot or link T(p, q)", ("p", "q")),
    "BRAID": ("Braid", "Strands that cross one by one and close in a circle", ("word",)),
    "LISSAJOUS": ("Lissajous", "Three oscillations at right angles", _OSCILLATIONS),
    "CABLE": ("Cable", "Strands along a knot, wound around each other", ("companion", "strands", "turns")),
    "DOUBLE": ("Double", "Two strands along a knot that hook into each other", ("companion", "twists", "left_clasp")),
}


def check_length(label: Message, value: float) -> None:
    """Raise an OptionError for values that Blender lets through although they are not numbers."""
    if not value <= 1e30:  # Blender computes with squares and products of such numbers
        sentence = "{label} is {value:g}; it must be a number up to {most:g}"
        raise OptionError(Message(sentence, label=label, value=value, most=1e30))


class AddsKnot(Button, AddObjectHelper):
    """An operator that makes a curve and adds it as an object at the 3D cursor."""

    needs = (OBJECT_MODE,)
    # what the panel shows besides what is its own and the tube: before and behind that
    common: Sequence[str] = ("size", "color_components")
    placing: Sequence[str] = ("align", "location", "rotation")

    size: FloatProperty(name="Size", description="Half of the knot's width", default=1.0, min=1e-4, unit="LENGTH")
    fit_bevel: BoolProperty(
        name="Fit Tube",
        description="Make the tube as thick as it can be without touching itself, rather than of a given Thickness",
        default=True,
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Radius of the tube; 0 for none. In a script, giving it turns Fit Tube off",
        default=0.0,
        min=0.0,
        unit="LENGTH",
    )
    color_components: BoolProperty(
        name="Color Components", description="Give each spline of a link a material of its own", default=True
    )

    def make(self) -> tuple[str, Curve]:
        """Make the curve, in any size and place, and name it; raises a MobiusFlowError if it cannot be made."""
        raise NotImplementedError

    def act(self, context: bpy.types.Context) -> None:
        self.check_lengths()
        name, curve = self.make()
        low, high = curve.vertices.min(axis=0), curve.vertices.max(axis=0)
        scale = 2 * self.size / (high - low).max()
        given = self.properties.is_property_set("location")
        obj = object_data_add(
            context, self.curve_data(name, scale * (curve.vertices - 0.5 * (low + high)), curve), self
        )
        if not given:
            # right of all others that are visible, unless it is clear of them where it is
            context.view_layer.update()
            low, high = box(obj)
            solid = {"MESH", "CURVE", "CURVES", "SURFACE", "META", "FONT", "VOLUME", "POINTCLOUD", "GREASEPENCIL"}
            boxes = [box(each) for each in context.visible_objects if each is not obj and each.type in solid]
            if any((low < other[1]).all() and (other[0] < high).all() for other in boxes):
                gap = 0.25 * (high - low)[0]
                obj.location.x += max(other[1][0] for other in boxes) + gap - low[0]
            self.location = obj.location

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Add it, and turn the view to it."""
        done = self.execute(context)
        if "FINISHED" in done and context.area is not None and context.area.type == "VIEW_3D":
            region = next(each for each in context.area.regions if each.type == "WINDOW")
            with context.temp_override(region=region):
                bpy.ops.view3d.view_selected()
        return done

    def curve_data(self, name: str, vertices: FloatArray, curve: Curve) -> bpy.types.Curve:
        """Make curve data of a curve with these vertices, shape (n, 3), its tube and its colours."""
        data = new_curve_data(name, curve.mesh)
        given = self.properties.is_property_set
        # kept, so that doing it again does the same
        self.fit_bevel = self.fit_bevel and (given("fit_bevel") or not given("thickness"))
        if self.fit_bevel:
            self.thickness = bevel.fitting_radius(curve.with_vertices(vertices))
        (bevel.fit if self.fit_bevel else bevel.draw)(data, self.thickness)
        write_points(data, vertices.astype("f4"))
        if self.color_components and len(curve.mesh.component_sizes) > 1:
            colour_components(data)
        return data

    def check_lengths(self) -> None:
        check_length(Message("Size"), self.size)
        check_length(Message("Thickness"), self.thickness)

    def own(self) -> Sequence[str]:
        """Names of the settings that only knots of its kind have."""
        return ()

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in (*self.own(), *self.common, "fit_bevel"):
            layout.prop(self, name)
        row = layout.row()
        row.enabled = not self.fit_bevel
        row.prop(self, "thickness")
        for name in self.placing:
            layout.prop(self, name)


def found(_operator: bpy.types.Operator, _context: bpy.types.Context, _text: str) -> list[str]:
    """All labels; Blender shows those that match what is typed."""
    return list(labels().values())


class CURVE_OT_mobius_flow_add_knot(AddsKnot, bpy.types.Operator):
    """Add a tangle to be relaxed: a hard unknot, a knot or link of the table as it is woven, or one made by a few \
numbers: a torus knot, braid, Lissajous curve, or two strands along a knot"""

    bl_label = "Knot"

    kind: EnumProperty(
        name="Kind",
        description="What makes the knot",
        items=[(key, title, description) for key, (title, description, _) in _KINDS.items()],
        default="TABLE",
    )
    knot: StringProperty(
        name="Knot", description="Name in the table, such as 3_1, T(2,5) or thistlethwaite", default="thistlethwaite"
    )
    p: IntProperty(name="p", description="How often the curve goes round the torus", default=2, soft_min=2)
    q: IntProperty(name="q", description="How often the curve goes through the torus", default=3, soft_min=2)
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
        if self.kind == "LISSAJOUS":
            frequencies, phases = (self.frequency_x, self.frequency_y, self.frequency_z), (self.phase_x, self.phase_y)
            return f"Lissajous{frequencies}".replace(" ", ""), knots.lissajous_knot(frequencies, phases)
        if self.kind in ("CABLE", "DOUBLE"):
            name = name_of(self.companion)
            along = knots.smooth_knot(name)
            if self.kind == "CABLE":
                return f"Cable({self.strands},{self.turns}) of {name}", knots.cable(along, self.strands, self.turns)
            return f"Double of {name}", knots.double(along, self.twists, clasp=-1 if self.left_clasp else 1)
        name = self.knot
        if self.kind == "TORUS":
            name = f"T({self.p},{self.q})"
        elif self.kind == "BRAID":
            name = f"braid({','.join(self.word.replace(',', ' ').split())})"
        numbers = map(int, re.findall(r"\d+", "".join(re.findall(r"\([^)]*\)", name))))
        if max(numbers, default=0) > 100:  # turns, or strands of a braid: 50,000 points and a second
            sentence = "{name} has a number beyond {most}, which is too much for a window; use smaller ones"
            raise OptionError(Message(sentence, name=name[:60], most=100))
        curve = knots.knot(name)  # woven so flat that its tube would be thin
        return name, knots.rounded(curve.with_vertices(curve.vertices * [1.0, 1.0, 2.0]))

    def own(self) -> Sequence[str]:
        return "kind", *_KINDS[self.kind][2]


class CURVE_OT_mobius_flow_pick_knot(AddsKnot, bpy.types.Operator):
    """Add a knot or link of the table, smooth, lying flat, with evenly spread strands; Relax lowers its energy"""

    bl_label = "Search Knot"
    bl_property = "choice"  # the property that the popup's list sets

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

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask which knot, unless one was given."""
        if self.properties.is_property_set("knot"):
            return super().invoke(context, event)
        context.window_manager.invoke_search_popup(self)
        return {"FINISHED"}

    def make(self) -> tuple[str, Curve]:
        if self.properties.is_property_set("choice"):
            self.knot = labels()[self.choice]
            self.properties.property_unset("choice")  # from now on only the name counts
        name = ("m" if self.mirror else "") + name_of(self.knot)
        return name, knots.smooth_knot(name, self.vertices or None)

    def own(self) -> Sequence[str]:
        return "knot", "mirror", "vertices"
