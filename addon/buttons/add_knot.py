"""The operator that adds knots by name."""

import re

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from ...core import MobiusFlowError, OptionError
from ..curves import bevel
from ..curves.exchange import new_curve_data, write_points

_MAX_NUMBER = 1e30  # Blender computes with squares and products of such numbers
_MAX_TURNS = 100  # of a torus knot, or strands of a braid: 50,000 points and a second


class CURVE_OT_mobius_flow_add_knot(bpy.types.Operator, AddObjectHelper):  # noqa: N801
    """Add a knot or link as closed poly splines"""

    bl_idname = "curve.mobius_flow_add_knot"
    bl_label = "Knot"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012

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

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether an object can be added."""
        cls.poll_message_set("Go back to Object Mode first")
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add the object at the 3D cursor."""
        from ...core.knots import knot

        name = self.knot if self.kind == "TABLE" else f"T({self.p},{self.q})"
        try:
            self._check(name)
            curve = knot(name)
        except MobiusFlowError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        low, high = curve.vertices.min(axis=0), curve.vertices.max(axis=0)
        scale = 2 * self.size / (high - low).max()
        data = new_curve_data(name, curve.mesh.component_sizes)
        vertices = scale * (curve.vertices - 0.5 * (low + high))
        self.fit_bevel = self._fits()  # so that doing it again does the same
        if self.fit_bevel:
            self.thickness = bevel.fitting_radius(curve.with_vertices(vertices))
        (bevel.fit if self.fit_bevel else bevel.draw)(data, self.thickness)
        write_points(data, vertices.astype("f4"))
        object_data_add(context, data, operator=self)
        return {"FINISHED"}

    def _check(self, name: str) -> None:
        """Raise an OptionError for what would freeze the window, or is not a number."""
        for label, value in (("Size", self.size), ("Thickness", self.thickness)):
            if not value <= _MAX_NUMBER:
                raise OptionError(f"{label} is {value:g}; it must be a number up to {_MAX_NUMBER:g}")
        for number in re.findall(r"\d+", "".join(re.findall(r"\([^)]*\)", name))):
            if int(number) > _MAX_TURNS:
                raise OptionError(
                    f"{name[:60]} has a number beyond {_MAX_TURNS}, which is too much for a window; use smaller ones"
                )

    def _fits(self) -> bool:
        given = self.properties.is_property_set
        return self.fit_bevel and (given("fit_bevel") or not given("thickness"))

    def draw(self, _context: bpy.types.Context) -> None:
        """Show the name or the torus parameters, not both."""
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "kind")
        for name in ("knot",) if self.kind == "TABLE" else ("p", "q"):
            layout.prop(self, name)
        layout.prop(self, "size")
        layout.prop(self, "fit_bevel")
        row = layout.row()
        row.enabled = not self.fit_bevel
        row.prop(self, "thickness")
        for name in ("align", "location", "rotation"):
            layout.prop(self, name)


CLASSES = (CURVE_OT_mobius_flow_add_knot,)
