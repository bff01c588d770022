"""The operators: they check, start a session, and say what happened."""

import re
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from ..core import MobiusFlowError, OptionError
from .curves import bevel
from .curves.exchange import new_curve_data, write_points
from .curves.session import Session
from .engine.timing import Pace
from .live.checks import edited, refusal, selected_curves, unsampled
from .live.start import LiveRelax, tell
from .properties import SETTINGS, relax_options, settings

_MAX_NUMBER = 1e30  # Blender computes with squares and products of such numbers
_MAX_TURNS = 100  # of a torus knot, or strands of a braid: 50,000 points and a second


class Relaxing(LiveRelax):
    """What all operators that relax have in common: their settings, and the whole job in one call."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender
    # For scripts; what is not given comes from the scene's settings, and nothing is remembered from run to run.
    __annotations__ = {
        **settings({"SKIP_SAVE", "HIDDEN"}),
        "sample_splines": BoolProperty(
            name="Sample Splines",
            description="Replace Bézier and NURBS splines by the polygons drawn for them",
            options={"SKIP_SAVE", "HIDDEN"},
        ),
    }

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str | None:
        """Say why the selected curves cannot be relaxed in this way, or return None if they can."""
        return refusal(context)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the selected curves can be relaxed; the tooltip says why not."""
        reason = cls.refusal(context)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job."""
        context.view_layer.update()  # a script may have moved the object just before
        values = self.values(context)
        try:
            if reason := self.refusal(context) or edited(context) or self._unasked(context):
                raise MobiusFlowError(reason)
            options, objects = self.key_options(context, values), selected_curves(context)
            report = Session(objects, relax_options(values), options, self.continues).run()
        except MobiusFlowError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except MemoryError:
            self.report({"ERROR"}, "Memory ran out; all is as it was. Take fewer Vertices or Max Iterations")
            return {"CANCELLED"}
        tell(self, context.scene, report)
        return {"FINISHED"}

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings: those given to the operator, and the scene's."""
        scene = context.scene.mobius_flow
        given = self.properties.is_property_set
        values = {name: getattr(self if given(name) else scene, name) for name in SETTINGS}
        # scripts that say how many frames an iterate takes mean that
        by_iterate = given("frames_per_iterate") and not given("timing")
        return values | ({"timing": Pace.ITERATE.name} if by_iterate else {})

    def _unasked(self, context: bpy.types.Context) -> str | None:
        return None if self.sample_splines else unsampled(selected_curves(context))


class CURVE_OT_mobius_flow_relax(Relaxing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Relax the selected curves together, never through themselves or each other, and keep the motion as keyframes"""

    bl_idname = "curve.mobius_flow_relax"
    bl_label = "Relax"


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
        from ..core.knots import knot

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
        bevel.fit(data, self.thickness)
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


CLASSES = (
    CURVE_OT_mobius_flow_relax,
    CURVE_OT_mobius_flow_add_knot,
)
