"""Tubes of curve objects as meshes with the same vertices at every key, for exporters and Geometry Nodes."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.types import FloatArray, IntArray
from ..engine.tube_mesh import caps, quads, rings
from .fcurves import FCurves
from .outputs import object_like
from .recorded import Recorded

if TYPE_CHECKING:
    import bpy

COLOUR = "colour"  # attribute of vertices


def tube_object(obj: "bpy.types.Object", recorded: Recorded, radii: FloatArray, sides: int) -> "bpy.types.Object":
    """Make a mesh object where a curve object is, with its motion as shape keys and its materials.

    Ends of open splines are closed where the curve fills its caps.

    Parameters
    ----------
    obj
        The curve object.
    recorded
        Its shapes.
    radii
        Radii of the tube in its coordinates, (keys, n).
    sides
        Number of vertices of a ring; those of curve vertex i are i · sides and the ones that follow.
    """
    import bpy

    curve, surface = recorded.mesh, rings(recorded.points, radii, recorded.mesh, sides)
    mesh = bpy.data.meshes.new(f"{obj.name} Tube")
    ends = caps(curve, sides)[: None if obj.data.use_fill_caps else 0]
    _fill(mesh, surface[0], [quads(curve, sides), ends])
    made = object_like(obj, mesh)
    corners = np.concatenate([curve.tails.repeat(sides), curve.ends.ravel()])  # a curve vertex of each face
    _take_materials(mesh, obj.data, curve.component[corners[: len(mesh.polygons)]])
    if len(surface) > 1:
        _write_keys(made, surface, recorded.frames)
    return made


def write_values(mesh: "bpy.types.Mesh", values: Mapping[str, FloatArray]) -> None:
    """Keep numbers of curve vertices, (n,) each, as attributes of their rings' vertices."""
    for name, array in values.items():
        attribute = mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", _on_rings(mesh, array))


def write_colours(mesh: "bpy.types.Mesh", colours: FloatArray, material: "bpy.types.Material") -> None:
    """Colour a tube by colours of curve vertices, linear RGB, (n, 3), in a material that shows them."""
    # bytes at the corners of faces are the only kind that Alembic keeps
    attribute = mesh.color_attributes.new(COLOUR, "BYTE_COLOR", "CORNER")
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    opaque = np.column_stack([colours, np.ones(len(colours))])
    attribute.data.foreach_set("color", _on_rings(mesh, opaque)[corners].ravel())
    mesh.color_attributes.active_color_index = mesh.color_attributes.render_color_index = 0
    mesh.materials.clear()
    mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", np.zeros(len(mesh.polygons), dtype=np.int32))


def _on_rings(mesh: "bpy.types.Mesh", values: FloatArray) -> FloatArray:
    sides = len(mesh.vertices) // len(values)
    return np.repeat(values, sides, axis=0).astype(np.float32)


def _fill(mesh: "bpy.types.Mesh", vertices: FloatArray, faces: Sequence[IntArray]) -> None:
    """Fill a mesh with faces, those with equally many corners in an array of their own."""
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


def _take_materials(mesh: "bpy.types.Mesh", data: "bpy.types.Curve", component: IntArray) -> None:
    for material in data.materials:
        mesh.materials.append(material)
    slots = np.array([spline.material_index for spline in data.splines], dtype=np.int32)
    mesh.polygons.foreach_set("material_index", slots[component])


def _write_keys(made: "bpy.types.Object", surface: FloatArray, frames: FloatArray) -> None:
    """Relative shape keys, of which at most two count at a time: what exporters know, and straight from key to key."""
    for frame, shape in zip(frames, surface, strict=True):
        block = made.shape_key_add(name=f"Frame {frame:g}", from_mix=False)
        block.data.foreach_set("co", shape.astype(np.float32).ravel())
    keys = made.data.shape_keys
    curves = FCurves(keys, f"{made.name} Motion")
    for k in range(1, len(frames)):
        near = slice(k - 1, k + 2)
        weights = np.array([0.0, 1.0, 0.0])[: len(frames[near])]
        curves.add(f'key_blocks["{keys.key_blocks[k].name}"].value', 0, frames[near], weights)
