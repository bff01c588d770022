"""Bézier and NURBS splines replaced by the polygons that Blender draws for them."""

from typing import TYPE_CHECKING

import numpy as np

from .motion import Frame

if TYPE_CHECKING:
    import bpy

_KINDS = {"BEZIER": "Bézier", "NURBS": "NURBS"}
POINT_VALUES = ("radius", "tilt", "weight_softbody")


def kind(spline: "bpy.types.Spline") -> str:
    """Name of a spline's type for people."""
    return _KINDS.get(spline.type, spline.type)


def smooth_splines(data: "bpy.types.Curve") -> list["bpy.types.Spline"]:
    """The splines that are no polygons yet."""
    return [spline for spline in data.splines if spline.type != "POLY"]


def question(obj: "bpy.types.Object") -> str:
    """Ask whether an object's smooth splines may become polygons."""
    smooth = smooth_splines(obj.data)
    kinds = " and ".join(sorted({kind(spline) for spline in smooth}))
    points = sum(len(points) for points, spline in zip(sampled(obj), obj.data.splines, strict=True) if spline in smooth)
    if len(smooth) == 1:
        return f"'{obj.name}' has a {kinds} spline; it becomes a polygon of {points} points"
    return f"'{obj.name}' has {len(smooth)} {kinds} splines; they become polygons of {points} points in all"


def sampled(obj: "bpy.types.Object") -> list[Frame]:
    """Points of all splines, each of shape (n, 3): smooth ones as drawn, at their own preview resolution."""
    import bpy

    data = obj.data.copy()
    bare = bpy.data.objects.new("Sampled", data)
    try:
        _strip(data)
        return _loops(bare.to_mesh())
    finally:
        bare.to_mesh_clear()
        bpy.data.objects.remove(bare)
        bpy.data.curves.remove(data)


def _strip(data: "bpy.types.Curve") -> None:
    """Leave nothing but the line itself."""
    data.bevel_mode, data.bevel_object, data.taper_object = "ROUND", None, None
    data.bevel_depth = data.extrude = data.offset = 0.0
    data.bevel_factor_start, data.bevel_factor_end = 0.0, 1.0


def _loops(mesh: "bpy.types.Mesh") -> list[Frame]:
    """The closed chains of a mesh; each has one edge that leads from its last vertex back to its first."""
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    edges = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.vertices.foreach_get("co", points)
    mesh.edges.foreach_get("vertices", edges)
    ends = np.sort(edges.reshape(-1, 2), axis=1)
    closing = ends[ends[:, 1] - ends[:, 0] > 1]
    return [points.reshape(-1, 3)[a : b + 1] for a, b in closing[closing[:, 0].argsort()]]


def make_poly(spline: "bpy.types.Spline", count: int) -> None:
    """Turn a smooth spline into a polygon of so many points, with its values in between; places are left open."""
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    values = {name: np.empty(len(points), dtype=np.float32) for name in POINT_VALUES}
    for name, array in values.items():
        points.foreach_get(name, array)
    spline.type = "POLY"
    spline.points.add(count - len(spline.points))
    place = np.arange(count) * len(values["radius"]) / count
    for name, array in values.items():
        closed = np.append(array, array[0])
        spline.points.foreach_set(name, np.interp(place, np.arange(len(closed)), closed).astype(np.float32))
