"""What operators that add knots have in common: size, tube, colours, and the place of the new object."""

import bpy
from bpy.props import BoolProperty, FloatProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from ...core import Curve, MobiusFlowError, OptionError
from ...core.messages import Message
from ...core.types import FloatArray
from ..curves import bevel
from ..curves.exchange import new_curve_data, write_points
from ..pictures.materials import colour_components
from ..translations import rpt_, tip_

_MAX_NUMBER = 1e30  # Blender computes with squares and products of such numbers


def check_length(label: Message, value: float) -> None:
    """Raise an OptionError for what Blender lets through but is no number."""
    if not value <= _MAX_NUMBER:
        sentence = "{label} is {value:g}; it must be a number up to {most:g}"
        raise OptionError(Message(sentence, label=label, value=value, most=_MAX_NUMBER))


class AddsKnot(AddObjectHelper):
    """An operator that makes a curve and adds it as an object at the 3D cursor."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012

    size: FloatProperty(name="Size", description="Half of the knot's width", default=1.0, min=1e-4, unit="LENGTH")
    fit_bevel: BoolProperty(
        name="Fit Tube",
        description="Make the tube as thick as it can be without touching itself, rather than of a given Thickness",
        default=True,
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Radius of the tube; 0 for none. In a script, to give it turns Fit Tube off",
        default=0.0,
        min=0.0,
        unit="LENGTH",
    )
    color_components: BoolProperty(
        name="Color Components", description="Give each spline of a link a material of its own", default=True
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether an object can be added."""
        cls.poll_message_set(tip_("Go back to Object Mode first"))
        return context.mode == "OBJECT"

    def make(self) -> tuple[str, Curve]:
        """Make the curve, in any size and place, and name it; raises a MobiusFlowError for what cannot be made."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add the object at the 3D cursor."""
        try:
            self._check()
            name, curve = self.make()
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        low, high = curve.vertices.min(axis=0), curve.vertices.max(axis=0)
        scale = 2 * self.size / (high - low).max()
        object_data_add(context, self.curve_data(name, scale * (curve.vertices - 0.5 * (low + high)), curve), self)
        return {"FINISHED"}

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

    def _check(self) -> None:
        """Raise an OptionError for what is not a number."""
        check_length(Message("Size"), self.size)
        check_length(Message("Thickness"), self.thickness)

    def _fits(self) -> bool:
        given = self.properties.is_property_set
        return self.fit_bevel and (given("fit_bevel") or not given("thickness"))

    def draw_kind(self, layout: bpy.types.UILayout) -> None:
        """Show what says which knot it is."""
        raise NotImplementedError

    def draw(self, _context: bpy.types.Context) -> None:
        """Show the knot's settings, then size, tube and place."""
        layout = self.layout
        layout.use_property_split = True
        self.draw_kind(layout)
        for name in ("size", "color_components"):
            layout.prop(self, name)
        self.draw_tube(layout)
        for name in ("align", "location", "rotation"):
            layout.prop(self, name)

    def draw_tube(self, layout: bpy.types.UILayout) -> None:
        """Show the tube's settings."""
        layout.prop(self, "fit_bevel")
        row = layout.row()
        row.enabled = not self.fit_bevel
        row.prop(self, "thickness")
