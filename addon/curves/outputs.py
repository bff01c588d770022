"""Objects made of curve objects, in the same place: tubes as meshes, and smooth splines."""

from collections.abc import Mapping, Sequence
from itertools import islice

import bpy
import numpy as np

from ...core import Curve
from ...core.base.types import FloatArray
from ...core.curve.tube import caps, quads, rings
from ...core.keys.smooth_fit import SmoothFit, bezier_points, fitted
from . import bevel
from .keyframes import add_keys
from .recorded import Recorded
from .sizes import placement
from .splines import read
from .surroundings import TUBE_OF

COLOUR = "colour"  # attribute of vertices
_LOOKS = ("bevel_mode", "bevel_depth", "bevel_resolution", "extrude", "offset", "taper_object", "bevel_object")
# fmt: off
_PLACE = (  # a matrix instead would be split into these anew, and lose shear and the last bits
    "rotation_mode", "location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale",
    "delta_location", "delta_rotation_euler", "delta_rotation_quaternion", "delta_scale",
    "parent_type", "parent", "parent_bone", "parent_vertices", "matrix_parent_inverse",
)
# fmt: on


def _object_like(obj: bpy.types.Object, data: bpy.types.ID) -> bpy.types.Object:
    """Make an object for other data, with the place and the parent of an object but not its animation."""
    made = bpy.data.objects.new(data.name, data)
    for name in _PLACE:
        setattr(made, name, getattr(obj, name))
    return made


def put_beside(made: bpy.types.Object, obj: bpy.types.Object, hide: bool) -> None:
    """Put a new object into the collections of its source, and select it instead."""
    for collection in obj.users_collection:
        collection.objects.link(made)
    made.select_set(True)
    obj.select_set(False)
    layer = bpy.context.view_layer.objects
    if layer.active is None or not layer.active.select_get():
        layer.active = made
    if hide:
        obj.hide_set(True)
        obj.hide_render = True


# -- tubes, with the same vertices at every key, for exporters and Geometry Nodes ------------------------------------


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
    made = _object_like(obj, mesh)
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


def write_values(mesh: bpy.types.Mesh, values: Mapping[str, FloatArray]) -> None:
    """Keep numbers of curve vertices, (n,) each, as attributes of their rings' vertices."""
    for name, array in values.items():
        attribute = mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", _on_rings(mesh, array))


def write_colours(mesh: bpy.types.Mesh, colours: FloatArray, material: bpy.types.Material) -> None:
    """Colour a tube by colours of curve vertices, linear RGB, (n, 3), in a material that shows them."""
    # bytes at the corners of faces are the only kind that Alembic keeps
    attribute = mesh.color_attributes.new(COLOUR, "BYTE_COLOR", "CORNER")
    opaque = np.column_stack([colours, np.ones(len(colours))])
    corners = read(mesh.loops, "vertex_index", dtype=np.int32)
    attribute.data.foreach_set("color", _on_rings(mesh, opaque)[corners].ravel())
    mesh.color_attributes.active_color_index = mesh.color_attributes.render_color_index = 0
    mesh.materials.clear()
    mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", np.zeros(len(mesh.polygons), dtype=np.int32))


def _on_rings(mesh: bpy.types.Mesh, values: FloatArray) -> FloatArray:
    return np.repeat(values, len(mesh.vertices) // len(values), axis=0).astype(np.float32)


# -- smooth splines --------------------------------------------------------------------------------------------------


def smooth_objects(
    objects: Sequence[bpy.types.Object], link: Curve, points: int | None, kind: str
) -> tuple[list[bpy.types.Object], SmoothFit]:
    """Make curve objects of smooth splines where others are, with their bevels and materials.

    ``link``: their splines as polygons in the world; ``points``: number of points of each spline, see `fitted`;
    ``kind``: 'BEZIER' or 'NURBS'. Returns the objects, and the splines as they are stored in them, in the world.
    """
    wanted = iter(fitted(link, points).points)
    made, shown = [], []
    for obj in objects:
        place = placement(obj)
        stored = [place.to_local(each).astype(np.float32) for each in islice(wanted, len(obj.data.splines))]
        data = bpy.data.curves.new(f"{obj.name} Smooth", "CURVE")
        data.dimensions, data.resolution_u = "3D", 12
        for name in _LOOKS:
            setattr(data, name, getattr(obj.data, name))
        if bevel.is_fitted(obj.data):
            bevel.fit(data, data.bevel_depth)
        for material in obj.data.materials:
            data.materials.append(material)
        for control, old in zip(stored, obj.data.splines, strict=True):
            spline = data.splines.new(kind)
            spline.use_cyclic_u = old.use_cyclic_u
            spline.material_index = old.material_index
            if kind == "NURBS":
                spline.points.add(len(control) - 1)
                spline.points.foreach_set("co", np.pad(control, ((0, 0), (0, 1)), constant_values=1.0).ravel())
                spline.order_u, spline.use_endpoint_u = 4, not spline.use_cyclic_u
                continue
            bezier = bezier_points(control.astype(np.float64), bool(spline.use_cyclic_u))
            middle, right, left = bezier[:, 0], bezier[:, 1], bezier[:, 2]
            if spline.use_cyclic_u:
                left = np.roll(left, 1, axis=0)
            else:  # the outer handles mirror the inner ones
                middle = np.concatenate([middle, bezier[-1:, 3]])
                before, after = 2 * middle[:1] - right[:1], 2 * middle[-1:] - left[-1:]
                right, left = np.concatenate([right, after]), np.concatenate([before, left])
            points_of = spline.bezier_points
            points_of.add(len(middle) - 1)
            for point in points_of:  # aligned handles stay in line when somebody moves them
                point.handle_left_type = point.handle_right_type = "ALIGNED"
            for name, array in (("co", middle), ("handle_right", right), ("handle_left", left)):
                points_of.foreach_set(name, array.astype(np.float32).ravel())
        made.append(_object_like(obj, data))
        shown += [place.to_world(each.astype(np.float64)) for each in stored]
    return made, SmoothFit(link, tuple(shown))
