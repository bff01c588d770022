"""Operators that turn relaxed curves into meshes of their tubes, or into smooth curves."""

from collections.abc import Sequence

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...core import Curve
from ...core.base.messages import Message
from ...core.curve.tube import places_between
from ...core.driver.words import named
from ...core.keys.colours import COLOURINGS, COMPONENT, DISTANCE, ENERGY, vertex_values
from ...core.keys.smooth_fit import FEWEST
from ..curves import bevel, outputs
from ..curves.outputs import put_beside, smooth_objects
from ..curves.recorded import Recorded, in_world
from ..curves.splines import length, stretch
from ..live.requirements import READABLE, selected_curves
from ..pictures.materials import compute_values, vertex_colours
from ..translations import rpt_
from .adding import check_length
from .button import Button

_PLAIN = "NONE"
_Objects, _Records = Sequence[bpy.types.Object], Sequence[Recorded]


class _Output(Button):
    __annotations__ = {
        "hide_curve": BoolProperty(
            name="Hide Curve",
            description="Hide the curve, which is in the same place, in views and renders",
            default=True,
        )
    }

    needs = (READABLE,)

    def act(self, context: bpy.types.Context) -> None:
        """Make an object from each, all of them before any is shown; ``link`` is the end of all in the world."""
        objects = selected_curves(context)
        recorded = [self.read(obj) for obj in objects]
        link = in_world(objects, recorded, [each.points[-1] for each in recorded])
        for made, obj in zip(self.make(objects, recorded, link), objects, strict=True):
            put_beside(made, obj, self.hide_curve)

    def read(self, obj: bpy.types.Object) -> Recorded:
        return Recorded.of(obj)


class CURVE_OT_mobius_flow_tube_mesh(_Output, bpy.types.Operator):
    """Make meshes of the selected curves' tubes, with their keys as shape keys of the same vertices. \
glTF, USD and Alembic keep motion and colors (Alembic with Color Attributes on); \
FBX does with NLA Strips and All Actions off, one frame later"""

    bl_label = "Tube Mesh"
    __annotations__ = {
        "color": EnumProperty(
            name="Color",
            description="What the vertices are colored by, as the curves are at the end of their animation",
            items=[
                (_PLAIN, "Materials", "The curve's own materials"),
                (COMPONENT, "Component", "A color for each spline"),
                (DISTANCE, "Distance", "The distance to the nearest other strand: yellow where it is near"),
                (ENERGY, "Energy", "The Möbius energy per length: yellow where there is much of it"),
            ],
            default=_PLAIN,
        ),
        "radius": FloatProperty(
            name="Radius",
            description="Radius of the tubes; 0: as they are drawn, and where nothing is drawn as thick as fits",
            default=0.0,
            min=0.0,
            unit="LENGTH",
        ),
        "sides": IntProperty(
            name="Sides", description="Number of vertices round the tube", default=16, min=3, soft_max=64, max=256
        ),
        "every_frame": BoolProperty(
            name="Attributes at Every Frame",
            description="Work out arc_length, curvature and strand_distance at every frame, in a modifier of nodes",
            default=False,
        ),
        **_Output.__annotations__,
    }

    def act(self, context: bpy.types.Context) -> None:
        check_length(Message("Radius"), self.radius)
        super().act(context)

    def read(self, obj: bpy.types.Object) -> Recorded:
        """Read the shapes of a curve, with more of them where it turns far from key to key."""
        recorded = Recorded.of(obj)
        return recorded.at(places_between(recorded.points, recorded.mesh))

    def make(self, objects: _Objects, recorded: _Records, link: Curve) -> list[bpy.types.Object]:
        """Make the meshes; the numbers that colors may show become attributes."""
        values, first, made = vertex_values(link), 0, []
        drawn = all(obj.data.bevel_depth for obj in objects)
        wanted = self.radius or (0.0 if drawn else bevel.fitting_radius(link))  # in the world
        colours = None if self.color == _PLAIN else COLOURINGS[self.color](values[self.color])
        for obj, each in zip(objects, recorded, strict=True):
            depth = 0.0 if self.radius else obj.data.bevel_depth
            radii = depth * each.radii if depth else np.full(each.radii.shape, wanted / stretch(obj))
            tube = outputs.tube_object(obj, each, radii, self.sides)
            part = slice(first, first := first + each.mesh.size)
            outputs.write_values(tube.data, {name: array[part] for name, array in values.items()})
            if self.every_frame:
                compute_values(tube, each.mesh)
            if colours is not None:
                outputs.write_colours(tube.data, colours[part], vertex_colours(outputs.COLOUR))
            made.append(tube)
        if own := [obj.name for obj in objects if obj.data.bevel_mode != "ROUND" or obj.data.taper_object]:
            sentence = "The tube of {names} is round: profiles and tapers are left out"
            self.report({"WARNING"}, rpt_(sentence, names=named(own)))
        else:
            keys, names = max(len(each.frames) for each in recorded), named([obj.name for obj in objects])
            several = "{names}: {count} vertices with {keys} shape keys"
            made_of = {"names": names, "count": link.mesh.size * self.sides, "keys": keys}
            self.report({"INFO"}, rpt_(several if keys > 1 else "{names}: {count} vertices", **made_of))
        return made


class CURVE_OT_mobius_flow_smooth_curve(_Output, bpy.types.Operator):
    """Make smooth splines of the selected curves as they are at the end of their animation, and say how far off they \
are. USD and Alembic keep the control points, glTF and FBX what is drawn (glTF nothing without a bevel)"""

    bl_label = "Smooth Curve"
    __annotations__ = {
        "kind": EnumProperty(
            name="Type",
            description="What the splines are; both are the same curve",
            items=[
                ("BEZIER", "Bézier", "Points on the curve, with handles"),
                ("NURBS", "NURBS", "Control points beside the curve"),
            ],
            default="BEZIER",
        ),
        "points": IntProperty(
            name="Points",
            description="Number of points of each spline; 0: as few as the eye needs",
            default=0,
            min=0,
            soft_max=200,
            max=10_000,
        ),
        **_Output.__annotations__,
    }

    def make(self, objects: _Objects, recorded: _Records, link: Curve) -> list[bpy.types.Object]:
        """Make the splines of all objects together: the strand that one comes near may belong to another."""
        points = max(self.points, FEWEST) if self.points else None
        made, fit = smooth_objects(objects, link, points, self.kind)
        scene, names = bpy.context.scene, named([obj.name for obj in objects])
        count, error = sum(map(len, fit.points)), length(scene, fit.error)
        said = Message("{names}: {count} points, at most {error} off", names=names, count=count, error=error)
        if fit.proved:
            self.report({"INFO"}, rpt_("{made}; the same knot, proved", made=said))
            return made
        if np.isfinite(fit.gap):
            gap = length(scene, fit.gap)
            said = Message("{made}, where strands are only {gap} apart", made=said, gap=gap)
        self.report({"WARNING"}, rpt_("{made}; NOT proved to be the same knot, so give it more Points", made=said))
        return made
