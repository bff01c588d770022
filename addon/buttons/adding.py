"""Operators that add knots by name, woven or smooth, and the base of all operators that add knots."""

import re

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add
from mathutils import Vector

from ...core import Curve, OptionError, knots
from ...core.messages import Message
from ...core.types import FloatArray
from ..curves import bevel
from ..curves.exchange import box, new_curve_data, write_points
from ..engine.knot_list import labels, name_of
from ..live.requirements import Condition
from ..pictures.materials import colour_components
from .button import Button

OBJECT_MODE = Condition("Go back to Object Mode first", lambda context: context.mode != "OBJECT")
_MAX_TURNS = 100  # of a torus knot, or strands of a braid: 50,000 points and a second
_SOLID = {"MESH", "CURVE", "CURVES", "SURFACE", "META", "FONT", "VOLUME", "POINTCLOUD", "GREASEPENCIL"}
_MARGIN = 0.25  # of its width, between a new knot and what is beside it
_RAISED = 1.0, 1.0, 2.0  # woven knots lie so flat that their tubes would be thin
_MAX_NUMBER = 1e30  # Blender computes with squares and products of such numbers


def check_length(label: Message, value: float) -> None:
    """Raise an OptionError for values that Blender lets through although they are not numbers."""
    if not value <= _MAX_NUMBER:
        sentence = "{label} is {value:g}; it must be a number up to {most:g}"
        raise OptionError(Message(sentence, label=label, value=value, most=_MAX_NUMBER))


class AddsKnot(Button, AddObjectHelper):
    """An operator that makes a curve and adds it as an object at the 3D cursor."""

    needs = (OBJECT_MODE,)

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
            self.location = obj.location = _beside(context, obj)

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
        self.fit_bevel = self._fits()  # so that doing it again does the same
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

    def _fits(self) -> bool:
        given = self.properties.is_property_set
        return self.fit_bevel and (given("fit_bevel") or not given("thickness"))

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        raise NotImplementedError

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        self.draw_kind(layout)
        for name in ("size", "color_components"):
            layout.prop(self, name)
        self.draw_tube(layout)
        for name in ("align", "location", "rotation"):
            layout.prop(self, name)

    def draw_tube(self, layout: bpy.types.UILayout) -> None:
        layout.prop(self, "fit_bevel")
        row = layout.row()
        row.enabled = not self.fit_bevel
        row.prop(self, "thickness")


def _beside(context: bpy.types.Context, obj: bpy.types.Object) -> Vector:
    """Where an object is clear of all others that are visible: where it is, or else to their right."""
    context.view_layer.update()
    low, high = box(obj)
    boxes = [box(each) for each in context.visible_objects if each is not obj and each.type in _SOLID]
    if any((low < other[1]).all() and (other[0] < high).all() for other in boxes):
        return obj.location + Vector((max(other[1][0] for other in boxes) + _MARGIN * (high - low)[0] - low[0], 0, 0))
    return obj.location


class CURVE_OT_mobius_flow_add_knot(AddsKnot, bpy.types.Operator):
    """Add a tangle to be relaxed: a hard unknot, a knot or link of the table as it is woven, a torus knot or braid"""

    bl_label = "Knot"

    kind: EnumProperty(
        name="Kind",
        items=[
            ("TABLE", "Name", "A knot or link of the table"),
            ("TORUS", "Torus", "The torus knot or link T(p, q)"),
        ],
        default="TABLE",
    )
    knot: StringProperty(
        name="Knot", description="Name in the table, such as 3_1, T(2,5) or thistlethwaite", default="thistlethwaite"
    )
    p: IntProperty(name="p", description="How often the curve goes round the torus", default=2, soft_min=2)
    q: IntProperty(name="q", description="How often the curve goes through the torus", default=3, soft_min=2)

    def make(self) -> tuple[str, Curve]:
        name, curve = named_knot(self.knot if self.kind == "TABLE" else f"T({self.p},{self.q})")
        return name, knots.rounded(curve.with_vertices(curve.vertices * _RAISED))

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        layout.prop(self, "kind")
        for name in ("knot",) if self.kind == "TABLE" else ("p", "q"):
            layout.prop(self, name)


def named_knot(name: str) -> tuple[str, Curve]:
    """A woven knot and its name; raises an OptionError if a torus knot or braid would freeze the window."""
    numbers = map(int, re.findall(r"\d+", "".join(re.findall(r"\([^)]*\)", name))))
    if max(numbers, default=0) > _MAX_TURNS:
        sentence = "{name} has a number beyond {most}, which is too much for a window; use smaller ones"
        raise OptionError(Message(sentence, name=name[:60], most=_MAX_TURNS))
    return name, knots.knot(name)


def found(_operator: bpy.types.Operator, _context: bpy.types.Context, _text: str) -> list[str]:
    """All labels; Blender shows those that match what is typed."""
    return list(labels().values())


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

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        for name in ("knot", "mirror", "vertices"):
            layout.prop(self, name)
