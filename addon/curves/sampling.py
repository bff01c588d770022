"""Bézier and NURBS splines seen as the polygons that Blender draws for them."""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import CurveError
from ...core.messages import Message
from ..engine.placement import Frame
from .splines import read

_KINDS = {"BEZIER": "Bézier", "NURBS": "NURBS"}
_MAX_QUESTIONS = 5


def kind(spline: bpy.types.Spline) -> str:
    """Name of a spline's type, as messages show it."""
    return _KINDS.get(spline.type, str(spline.type))


def smooth_splines(data: bpy.types.Curve) -> list[bpy.types.Spline]:
    """The splines that are no polygons yet."""
    return [spline for spline in data.splines if spline.type != "POLY"]


def questions(objects: Sequence[bpy.types.Object]) -> list[str]:
    """Ask whether the smooth splines of objects may become polygons, a line each; raises as `sampled` does."""
    smooth = [obj for obj in objects if smooth_splines(obj.data)]
    lines = [_question(obj) for obj in smooth[:_MAX_QUESTIONS]]
    more = len(smooth) - len(lines)
    return [*lines, Message("{count} more objects have smooth splines too", count=more)] if more else lines


def _question(obj: bpy.types.Object) -> str:
    smooth = smooth_splines(obj.data)
    kinds = sorted({kind(spline) for spline in smooth})
    points = sum(len(points) for points, spline in zip(sampled(obj), obj.data.splines, strict=True) if spline in smooth)
    if len(smooth) == 1:
        one = "'{name}' has a {kind} spline; it becomes a polygon of {points} points"
        return Message(one, name=obj.name, kind=kinds[0], points=points)
    several = "'{name}' has {count} {kinds} splines; they become polygons of {points} points in all"
    both = Message("{names} and {last}", names=kinds[0], last=kinds[-1])
    return Message(several, name=obj.name, count=len(smooth), kinds=both if kinds[1:] else kinds[0], points=points)


def sampled(obj: bpy.types.Object) -> list[Frame]:
    """Points of all splines, each of shape (n, 3): smooth ones as drawn, at their own preview resolution.

    Raises CurveError if no polygon is drawn for a spline.
    """
    loops = _drawn(obj.data)
    if len(loops) != len(obj.data.splines):
        sentence = "'{name}' has splines that Blender draws nothing for; delete them, or convert all to Poly first"
        raise CurveError(Message(sentence, name=obj.name))
    for k, (loop, spline) in enumerate(zip(loops, obj.data.splines, strict=True), 1):
        if len(loop) < (3 if spline.use_cyclic_u else 2):
            sentence = (
                "Spline {number} of '{name}' is drawn with only {count} points; raise its Resolution U, or give it "
                "more points"
            )
            raise CurveError(Message(sentence, number=k, name=obj.name, count=len(loop)))
    return loops


def _drawn(data: bpy.types.Curve) -> list[Frame]:
    """The line itself, without all that is drawn around it."""
    copy = data.copy()
    bare = bpy.data.objects.new("Sampled", copy)
    try:
        copy.dimensions = "3D"  # flat curves would be filled
        copy.bevel_mode, copy.bevel_object, copy.taper_object = "ROUND", None, None
        copy.bevel_depth = copy.extrude = copy.offset = 0.0
        copy.bevel_factor_start, copy.bevel_factor_end = 0.0, 1.0
        return _loops(bare.to_mesh())
    finally:
        bare.to_mesh_clear()
        bpy.data.objects.remove(bare)
        bpy.data.curves.remove(copy)


def _loops(mesh: bpy.types.Mesh) -> list[Frame]:
    """The chains of a mesh: vertices one after the other, each joined to the next."""
    points, edges = read(mesh.vertices, "co", 3), read(mesh.edges, "vertices", 2, np.int32)
    low, high = np.sort(edges, axis=1).T
    starts = np.setdiff1d(np.arange(len(mesh.vertices)), high[high - low == 1])
    return np.split(points, starts[1:]) if len(starts) else []
