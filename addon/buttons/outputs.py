"""Operators that turn relaxed curves into meshes of their tubes, or into smooth curves, in the same place."""

from collections.abc import Mapping, Sequence
from itertools import islice

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...core import Curve
from ...core.base import FloatArray, Message
from ...core.curve.tube import caps, places_between, quads, rings
from ...core.driver.words import named
from ...core.keys.colours import COLOURINGS, COMPONENT, DISTANCE, ENERGY, vertex_values
from ...core.keys.smooth_fit import FEWEST, SmoothFit, bezier_points, fitted
from ..curves import bake, bevel
from ..curves.assets import add_nodes
from ..curves.doors import object_like, show_instead
from ..curves.keyframes import add_keys
from ..curves.recorded import Recorded, in_world
from ..curves.sizes import placement
from ..curves.splines import SOURCE, depth, length, read
from ..curves.surroundings import TUBE_OF
from ..live.requirements import READABLE
from ..live.selection import selected_curves
from ..pictures.materials import vertex_colours
from ..translations import rpt_
from .adding import check_length
from .button import Button

_PLAIN = "NONE"
COLOUR = "colour"  # attribute of vertices
_Objects, _Records = Sequence[bpy.types.Object], Sequence[Recorded]


_HIDE_CURVE = BoolProperty(
    name="Hide Curve", description="Hide the curve, which is in the same place, in views and renders", default=True
)


class _Output(Button):
    needs = (READABLE,)

    def act(self, context: bpy.types.Context) -> None:
        """Make an object from each, all of them before any is shown, and select it instead."""
        objects = selected_curves(context)
        recorded = [self.read(obj) for obj in objects]
        link = in_world(objects, recorded, [each.points[-1] for each in recorded])
        for made, obj in zip(self.make(objects, recorded, link), objects, strict=True):
            show_instead(obj, made)
            if self.hide_curve:
                obj.hide_set(True)
                obj.hide_render = True
        layer = context.view_layer.objects
        if layer.active is None or not layer.active.select_get():
            layer.active = made

    def read(self, obj: bpy.types.Object) -> Recorded:
        return Recorded.of(obj)


class CURVE_OT_mobius_flow_tube_mesh(_Output, bpy.types.Operator):
    """Make meshes of the selected curves' tubes, with their keys as shape keys of the same vertices. \
glTF, USD and Alembic keep motion and colors (Alembic with Color Attributes on); \
FBX does with NLA Strips and All Actions off, one frame later"""

    bl_label = "Tube Mesh"
    color: EnumProperty(
        name="Color",
        description="What the vertices are colored by, as the curves are at the end of their animation",
        items=[
            (_PLAIN, "Materials", "The curve's own materials"),
            (COMPONENT, "Component", "A color for each spline"),
            (DISTANCE, "Distance", "The distance to the nearest other strand: yellow where it is near"),
            (ENERGY, "Energy", "The Möbius energy per length: yellow where there is much of it"),
        ],
        default=_PLAIN,
    )
    radius: FloatProperty(
        name="Radius",
        description="Radius of the tubes; 0: as they are drawn, or else as the rope, or as thick as fits",
        default=0.0,
        min=0.0,
        unit="LENGTH",
    )
    sides: IntProperty(
        name="Sides", description="Number of vertices round the tube", default=16, min=3, soft_max=64, max=256
    )
    every_frame: BoolProperty(
        name="Attributes at Every Frame",
        description="Work out arc_length, curvature and strand_distance at every frame, in a modifier of nodes",
        default=False,
    )
    hide_curve: _HIDE_CURVE

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
        drawn = all(depth(obj.data) for obj in objects)
        rope = bevel.rope_radii(objects)
        fits = 0.0 if drawn else float(rope.min()) if len(rope) else bevel.fitting_radius(link)
        wanted = self.radius or fits  # in the world
        colours = None if self.color == _PLAIN else COLOURINGS[self.color](values[self.color])
        for obj, each in zip(objects, recorded, strict=True):
            thick = 0.0 if self.radius else depth(obj.data)
            radii = thick * each.radii if thick else np.full(each.radii.shape, wanted / placement(obj).stretch)
            tube = tube_object(obj, each, radii, self.sides)
            part = slice(first, first := first + each.mesh.size)
            write_values(tube.data, {name: array[part] for name, array in values.items()})
            forces, struts = bake.contacts(obj.data)
            if len(forces) == each.mesh.size:
                write_values(tube.data, {"contact_force": forces})
                obj.users_collection[0].objects.link(struts_object(obj, struts))
            if self.every_frame:
                # at the middles of the rings as shown, Blender's nodes compute the arc length from the start of a
                # component; the curvature, which is the angle by which the polygon turns over half the length of both
                # edges, and 0 at open ends; and the distance to the nearest edge of another strand
                closed = np.array(each.mesh.closed, dtype=np.float64)[each.mesh.component]
                write_values(tube.data, {"ring": np.arange(each.mesh.size, dtype=np.float64), "closed": closed})
                add_nodes(tube, "Möbius Flow Attributes")
            if colours is not None:
                write_colours(tube.data, colours[part])
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
    kind: EnumProperty(
        name="Type",
        description="What the splines are; both are the same curve",
        items=[
            ("BEZIER", "Bézier", "Points on the curve, with handles"),
            ("NURBS", "NURBS", "Control points beside the curve"),
        ],
        default="BEZIER",
    )
    points: IntProperty(
        name="Points",
        description="Number of points of each spline; 0: as few as the eye needs",
        default=0,
        min=0,
        soft_max=200,
        max=10_000,
    )
    hide_curve: _HIDE_CURVE

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


def tube_object(obj: bpy.types.Object, recorded: Recorded, radii: FloatArray, sides: int) -> bpy.types.Object:
    """Make a mesh object where a curve object is, with its motion as shape keys, its materials and its caps.

    ``radii``: of the tube in the object's coordinates, (keys, n). Rings have ``sides`` vertices; those of curve vertex
    i are i · sides and the ones that follow.
    """
    curve, surface = recorded.mesh, rings(recorded.points, radii, recorded.mesh, sides)
    mesh = bpy.data.meshes.new(f"{obj.name} Tube")
    ends = caps(curve, sides)[: None if obj.data.use_fill_caps else 0]
    mesh.from_pydata(surface[0].tolist(), [], [*quads(curve, sides).tolist(), *ends.tolist()])
    mesh.polygons.foreach_set("use_smooth", np.arange(len(mesh.polygons)) < len(mesh.polygons) - len(ends))
    made = object_like(obj, mesh)
    made[TUBE_OF] = obj
    corners = np.concatenate([curve.tails.repeat(sides), curve.ends.ravel()])  # a curve vertex of each face
    for material in obj.data.materials:
        mesh.materials.append(material)
    slots = np.array([spline.material_index for spline in obj.data.splines], dtype=np.int32)
    mesh.polygons.foreach_set("material_index", slots[curve.component[corners[: len(mesh.polygons)]]])
    # relative shape keys, at most two active at a time: exporters support them, and motion is straight in between
    if len(frames := recorded.frames) > 1:
        for frame, shape in zip(frames, surface, strict=True):
            block = made.shape_key_add(name=f"Frame {frame:g}", from_mix=False)
            block.data.foreach_set("co", shape.astype(np.float32).ravel())
        for k, block in enumerate(mesh.shape_keys.key_blocks[1:], 1):
            near, path = frames[k - 1 : k + 2], f'key_blocks["{block.name}"].value'
            add_keys(mesh.shape_keys, f"{made.name} Motion", path, 0, near, np.array([0.0, 1.0, 0.0])[: len(near)])
    return made


def struts_object(obj: bpy.types.Object, struts: FloatArray) -> bpy.types.Object:
    """Make a mesh of a curve's struts, edges that have their forces, relative to the tension, as an attribute."""
    mesh = bpy.data.meshes.new(f"{obj.name} Struts")
    mesh.from_pydata(struts[:, :6].reshape(-1, 3).tolist(), np.arange(2 * len(struts)).reshape(-1, 2).tolist(), [])
    mesh.attributes.new("force", "FLOAT", "EDGE").data.foreach_set("value", struts[:, 6].astype(np.float32))
    made = object_like(obj, mesh)
    made[TUBE_OF] = obj
    return made


def write_values(mesh: bpy.types.Mesh, values: Mapping[str, FloatArray]) -> None:
    """Keep numbers of curve vertices, (n,) each, as attributes of their rings' vertices."""
    for name, array in values.items():
        attribute = mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", np.repeat(array, len(mesh.vertices) // len(array)).astype(np.float32))


def write_colours(mesh: bpy.types.Mesh, colours: FloatArray) -> None:
    """Colour a tube by colours of curve vertices, linear RGB, (n, 3), in a material that shows them."""
    # bytes at the corners of faces are the only kind that Alembic keeps
    attribute = mesh.color_attributes.new(COLOUR, "BYTE_COLOR", "CORNER")
    opaque = np.column_stack([colours, np.ones(len(colours))])
    corners = read(mesh.loops, "vertex_index", dtype=np.int32)
    shown = opaque[corners // (len(mesh.vertices) // len(colours))]
    attribute.data.foreach_set("color", shown.astype(np.float32).ravel())
    mesh.color_attributes.active_color_index = mesh.color_attributes.render_color_index = 0
    mesh.materials.clear()
    mesh.materials.append(vertex_colours(COLOUR))
    mesh.polygons.foreach_set("material_index", np.zeros(len(mesh.polygons), dtype=np.int32))


def smooth_objects(
    objects: Sequence[bpy.types.Object], link: Curve, points: int | None, kind: str
) -> tuple[list[bpy.types.Object], SmoothFit]:
    """Make curve objects of smooth splines where others are, with their bevels and materials.

    ``link``: their splines as polygons in the world; ``points``: number of points of each spline, see `fitted`;
    ``kind``: 'BEZIER' or 'NURBS'. Returns the objects, and the splines as they are stored in them, in the world.
    """
    wanted = iter(fitted(link, points).points)
    made, shown = list[bpy.types.Object](), list[FloatArray]()
    for obj in objects:
        place = placement(obj)
        stored = [place.to_local(each).astype(np.float32) for each in islice(wanted, len(obj.data.splines))]
        made.append(object_like(obj, data := obj.data.copy()))
        made[-1].name = data.name = f"{obj.name} Smooth"
        bake.forget(made[-1])
        data.animation_data_clear()
        data.pop(SOURCE, None)
        data.resolution_u = 12
        data.splines.clear()
        for control, old in zip(stored, obj.data.splines, strict=True):
            spline = data.splines.new(kind)
            spline.use_cyclic_u = old.use_cyclic_u
            spline.material_index = old.material_index
            if kind == "NURBS":
                spline.points.add(len(control) - 1)
                spline.points.foreach_set("co", np.pad(control, ((0, 0), (0, 1)), constant_values=1.0).ravel())
                spline.order_u, spline.use_endpoint_u = 4, not spline.use_cyclic_u
                continue
            middle, handle = bezier_points(control.astype(np.float64), bool(spline.use_cyclic_u))
            points_of = spline.bezier_points
            points_of.add(len(middle) - 1)
            for point in points_of:  # aligned handles stay in line when somebody moves them
                point.handle_left_type = point.handle_right_type = "ALIGNED"
            for name, side in (("co", 0.0), ("handle_right", 1.0), ("handle_left", -1.0)):
                points_of.foreach_set(name, (middle + side * handle).astype(np.float32).ravel())
        shown += [place.to_world(each.astype(np.float64)) for each in stored]
    return made, SmoothFit(link, tuple(shown))
