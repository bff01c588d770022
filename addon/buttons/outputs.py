"""Operators that turn relaxed curves into meshes of their tubes, or into smooth curves."""

from collections.abc import Sequence

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...core import Curve
from ...core.collision import check_embedded
from ...core.messages import Message
from ..curves import bevel, frame_values, outputs
from ..curves.exchange import length, stretch
from ..curves.frame_values import CLOSED, RING
from ..curves.outputs import put_beside, smooth_objects
from ..curves.recorded import Recorded, in_world
from ..engine.colours import COLOURINGS, COMPONENT, DISTANCE, ENERGY, vertex_values
from ..engine.interpolation import places_between
from ..engine.smooth_fit import FEWEST, SmoothFit
from ..engine.words import named
from ..live.checks import READABLE
from ..live.requirements import selected_curves
from ..pictures.materials import vertex_colours
from ..translations import rpt_
from .adding import check_length
from .button import Button

_PLAIN = "NONE"
_MAX_POINTS = 10_000
_Objects, _Records = Sequence[bpy.types.Object], Sequence[Recorded]


class _Output(Button):
    __annotations__ = {
        "hide_curve": BoolProperty(
            name="Hide Curve",
            description="Hide the curve, which is in the same place, in views and renders",
            default=True,
        ),
    }

    needs = (READABLE,)

    def act(self, context: bpy.types.Context) -> None:
        """Make an object from each, all of them before any is shown; ``link`` is the end of all in the world."""
        objects = selected_curves(context)
        recorded = [self.read(obj) for obj in objects]
        link = in_world(objects, recorded, [each.points[-1] for each in recorded])
        check_embedded(link)
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
        values, radii, first, made = vertex_values(link), self._radii(objects, recorded, link), 0, []
        colours = None if self.color == _PLAIN else COLOURINGS[self.color](values[self.color])
        for obj, each, own in zip(objects, recorded, radii, strict=True):
            tube = outputs.tube_object(obj, each, own, self.sides)
            part = slice(first, first := first + each.mesh.size)
            outputs.write_values(tube.data, {name: array[part] for name, array in values.items()})
            if self.every_frame:
                closed = np.array(each.mesh.closed, dtype=np.float64)[each.mesh.component]
                outputs.write_values(tube.data, {RING: np.arange(each.mesh.size, dtype=np.float64), CLOSED: closed})
                frame_values.add(tube)
            if colours is not None:
                outputs.write_colours(tube.data, colours[part], vertex_colours(outputs.COLOUR))
            made.append(tube)
        self._report(objects, recorded)
        return made

    def _radii(self, objects: _Objects, recorded: _Records, link: Curve) -> list[np.ndarray]:
        """Radii at all keys, in each object's coordinates; (keys, n) each."""
        drawn = [obj.data.bevel_depth for obj in objects]
        wanted = self.radius or (0.0 if all(drawn) else bevel.fitting_radius(link))
        return [
            np.full(each.radii.shape, wanted / stretch(obj)) if self.radius or not depth else depth * each.radii
            for obj, each, depth in zip(objects, recorded, drawn, strict=True)
        ]

    def _report(self, objects: _Objects, recorded: _Records) -> None:
        own = [obj.name for obj in objects if obj.data.bevel_mode != "ROUND" or obj.data.taper_object]
        if own:
            sentence = "The tube of {names} is round: profiles and tapers are left out"
            self.report({"WARNING"}, rpt_(sentence, names=named(own)))
        else:
            keys, vertices = max(len(each.frames) for each in recorded), sum(each.mesh.size for each in recorded)
            made = {"names": named([obj.name for obj in objects]), "count": vertices * self.sides, "keys": keys}
            several = "{names}: {count} vertices with {keys} shape keys"
            self.report({"INFO"}, rpt_(several if keys > 1 else "{names}: {count} vertices", **made))


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
            max=_MAX_POINTS,
        ),
        **_Output.__annotations__,
    }

    def make(self, objects: _Objects, recorded: _Records, link: Curve) -> list[bpy.types.Object]:
        """Make the splines of all objects together: the strand that one comes near may belong to another."""
        points = max(self.points, FEWEST) if self.points else None
        made, fit = smooth_objects(objects, link, points, self.kind)
        self._report(objects, fit)
        return made

    def _report(self, objects: _Objects, fit: SmoothFit) -> None:
        scene = bpy.context.scene
        said = Message(
            "{names}: {count} points, at most {error} off",
            names=named([obj.name for obj in objects]),
            count=sum(map(len, fit.points)),
            error=length(scene, fit.error),
        )
        if fit.proved:
            self.report({"INFO"}, rpt_("{made}; the same knot, proved", made=said))
            return
        if np.isfinite(fit.gap):
            gap = length(scene, fit.gap)
            said = Message("{made}, where strands are only {gap} apart", made=said, gap=gap)
        self.report({"WARNING"}, rpt_("{made}; NOT proved to be the same knot, so give it more Points", made=said))
