"""Objects made of curve objects, in the same place: tubes as meshes, and smooth splines."""

from collections.abc import Mapping, Sequence
from itertools import islice

import bpy
import numpy as np

from ...core import Curve
from ...core.tube import caps, quads, rings
from ...core.types import FloatArray, IntArray
from ..engine.placement import Frame, Placement
from ..engine.smooth_fit import SmoothFit, bezier_points, fitted
from . import bevel
from .keyframes import FCurves
from .recorded import Recorded
from .splines import read
from .surroundings import TUBE_OF

COLOUR = "colour"  # attribute of vertices
_LOOKS = ("bevel_mode", "bevel_depth", "bevel_resolution", "extrude", "offset", "taper_object", "bevel_object")
_RESOLUTION = 12  # points drawn for each segment of a smooth spline
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
    _fill(mesh, surface[0], [quads(curve, sides), ends])
    made = _object_like(obj, mesh)
    made[TUBE_OF] = obj
    corners = np.concatenate([curve.tails.repeat(sides), curve.ends.ravel()])  # a curve vertex of each face
    for material in obj.data.materials:
        mesh.materials.append(material)
    slots = np.array([spline.material_index for spline in obj.data.splines], dtype=np.int32)
    mesh.polygons.foreach_set("material_index", slots[curve.component[corners[: len(mesh.polygons)]]])
    if len(surface) > 1:
        _write_keys(made, surface, recorded.frames)
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


def _fill(mesh: bpy.types.Mesh, vertices: FloatArray, faces: Sequence[IntArray]) -> None:
    """Fill a mesh with faces; each array holds faces with equally many corners."""
    corners = np.concatenate([each.ravel() for each in faces])
    sizes = np.concatenate([np.full(len(each), each.shape[1]) for each in faces])
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners.astype(np.int32))
    mesh.polygons.add(len(sizes))
    mesh.polygons.foreach_set("loop_start", (np.cumsum(sizes) - sizes).astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", np.arange(len(sizes)) < len(faces[0]))
    mesh.update(calc_edges=True)


def _write_keys(made: bpy.types.Object, surface: FloatArray, frames: FloatArray) -> None:
    """Relative shape keys, at most two active at a time: exporters support them, and motion is straight in between."""
    for frame, shape in zip(frames, surface, strict=True):
        block = made.shape_key_add(name=f"Frame {frame:g}", from_mix=False)
        block.data.foreach_set("co", shape.astype(np.float32).ravel())
    keys = made.data.shape_keys
    curves = FCurves(keys, f"{made.name} Motion")
    for k in range(1, len(frames)):
        near = slice(k - 1, k + 2)
        weights = np.array([0.0, 1.0, 0.0])[: len(frames[near])]
        curves.add(f'key_blocks["{keys.key_blocks[k].name}"].value', 0, frames[near], weights)


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
        place = Placement.from_matrix(obj.matrix_world)
        stored = [place.to_local(each).astype(np.float32) for each in islice(wanted, len(obj.data.splines))]
        made.append(_smooth_object(obj, stored, kind))
        shown += [place.to_world(each.astype(np.float64)) for each in stored]
    return made, SmoothFit(link, tuple(shown))


def _smooth_object(obj: bpy.types.Object, control: Sequence[Frame], kind: str) -> bpy.types.Object:
    data = bpy.data.curves.new(f"{obj.name} Smooth", "CURVE")
    data.dimensions, data.resolution_u = "3D", _RESOLUTION
    for name in _LOOKS:
        setattr(data, name, getattr(obj.data, name))
    if bevel.is_fitted(obj.data):
        bevel.fit(data, data.bevel_depth)
    for material in obj.data.materials:
        data.materials.append(material)
    for points, old in zip(control, obj.data.splines, strict=True):
        spline = data.splines.new(kind)
        spline.use_cyclic_u = old.use_cyclic_u
        (_fill_bezier if kind == "BEZIER" else _fill_nurbs)(spline, points)
        spline.material_index = old.material_index
    return _object_like(obj, data)


def _fill_bezier(spline: bpy.types.Spline, control: Frame) -> None:
    bezier = bezier_points(control.astype(np.float64), bool(spline.use_cyclic_u))
    place, right, left = bezier[:, 0], bezier[:, 1], bezier[:, 2]
    if spline.use_cyclic_u:
        left = np.roll(left, 1, axis=0)
    else:  # the outer handles mirror the inner ones
        place = np.concatenate([place, bezier[-1:, 3]])
        before, after = 2 * place[:1] - right[:1], 2 * place[-1:] - left[-1:]
        right, left = np.concatenate([right, after]), np.concatenate([before, left])
    points = spline.bezier_points
    points.add(len(place) - 1)
    for point in points:  # aligned handles stay in line when somebody moves them
        point.handle_left_type = point.handle_right_type = "ALIGNED"
    for name, array in (("co", place), ("handle_right", right), ("handle_left", left)):
        points.foreach_set(name, array.astype(np.float32).ravel())


def _fill_nurbs(spline: bpy.types.Spline, control: Frame) -> None:
    spline.points.add(len(control) - 1)
    spline.points.foreach_set("co", np.pad(control, ((0, 0), (0, 1)), constant_values=1.0).ravel())
    spline.order_u, spline.use_endpoint_u = 4, not spline.use_cyclic_u
