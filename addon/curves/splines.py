"""The splines of curve data: copied with all settings of theirs and of their points, made into polygons, compared."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

from ...core import Curve, CurveError
from ...core.messages import Message
from ..engine.interpolation import along, on_refined
from ..engine.placement import Frame

_TYPES: dict[str, Any] = {"BOOLEAN": np.int32, "INT": np.int32, "FLOAT": np.float32, "ENUM": np.int32}
_POINT_VALUES = ("radius", "tilt", "weight_softbody")
_KINDS = {"BEZIER": "Bézier", "NURBS": "NURBS"}
_MAX_QUESTIONS = 5


@dataclass(frozen=True, eq=False)
class _Spline:
    """One spline: its own settings, and an array for every setting of its points."""

    type: str
    count: int
    settings: dict[str, Any]
    points: dict[str, npt.NDArray[Any]]

    @classmethod
    def of(cls, spline: bpy.types.Spline) -> "_Spline":
        points = control_points(spline)
        arrays = {}
        for prop in _properties(points[0]) if len(points) else ():
            width = max(getattr(prop, "array_length", 1), 1)  # only vectors have several numbers
            arrays[prop.identifier] = read(points, prop.identifier, width, _TYPES[prop.type])
        settings = {prop.identifier: getattr(spline, prop.identifier) for prop in _properties(spline)}
        if spline.type != "NURBS":
            del settings["order_u"]  # means nothing, and is made valid when it is set
        return cls(spline.type, len(points), settings, arrays)

    def put(self, spline: bpy.types.Spline) -> None:
        points = control_points(spline)
        points.add(self.count - len(points))
        for name, array in self.points.items():
            points.foreach_set(name, array.ravel())
        for name, value in self.settings.items():
            setattr(spline, name, value)


@dataclass(frozen=True, eq=False)
class Splines:
    """Copies of all splines of curve data."""

    each: Sequence[_Spline]
    active: int | None

    @classmethod
    def of(cls, data: bpy.types.Curve) -> "Splines":
        active = next((k for k, spline in enumerate(data.splines) if spline == data.splines.active), None)
        return cls([_Spline.of(spline) for spline in data.splines], active)

    def polygons(self, drawn: Curve, refined: Curve) -> "Splines":
        """The same as poly splines with the vertices of a refined curve; the positions of their points are left open.

        New points have values between those of their neighbours; all other settings stay. ``drawn``: the polygons that
        are drawn for the splines, a component each.
        """
        made = []
        for k, spline in enumerate(self.each):
            size, closed = drawn.mesh.component_sizes[k], drawn.mesh.closed[k]
            old, new = (curve.edge_lengths[curve.mesh.edge_slices[k]] for curve in (drawn, refined))
            points = {
                name: on_refined(along(spline.points[name], size, closed), old, new, closed).astype(np.float32)
                for name in _POINT_VALUES
            }
            settings = {name: value for name, value in spline.settings.items() if name != "order_u"}
            made.append(_Spline("POLY", refined.mesh.component_sizes[k], settings, points))
        return Splines(made, self.active)

    def fill(self, data: bpy.types.Curve) -> None:
        """Give these splines to curve data in place of its own."""
        data.splines.clear()
        for spline in self.each:
            spline.put(data.splines.new(spline.type))
        if self.active is not None:
            data.splines.active = data.splines[self.active]
        data.update_tag()


@dataclass(frozen=True)
class SplineShape:
    """A spline apart from the positions of its points: its type, their number, and whether it is closed."""

    type: str
    count: int
    closed: bool


def shape(data: bpy.types.Curve) -> list[SplineShape]:
    return [SplineShape(each.type, len(control_points(each)), bool(each.use_cyclic_u)) for each in data.splines]


def digest(data: bpy.types.Curve) -> bytes:
    """A fingerprint of the points and of the number of their keys; cheap enough for every redraw."""
    keys = len(data.shape_keys.key_blocks) if data.shape_keys else 0
    hashed = hashlib.blake2b(repr((shape(data), keys)).encode(), digest_size=16)
    for spline in data.splines:
        hashed.update(coordinates(spline).tobytes())
    return hashed.digest()


def control_points(spline: bpy.types.Spline) -> Any:
    """The points of a spline of any type."""
    return spline.bezier_points if spline.type == "BEZIER" else spline.points


def coordinates(spline: bpy.types.Spline) -> Frame:
    """The positions of the points of a spline of any type; shape (n, 3)."""
    width = 3 if spline.type == "BEZIER" else 4
    return read(control_points(spline), "co", width).reshape(-1, width)[:, :3]


def radii(spline: bpy.types.Spline) -> Frame:
    """Radii of the points of a spline of any type, relative to the bevel depth; shape (n,)."""
    return read(control_points(spline), "radius")


def read(items: Any, name: str, width: int = 1, dtype: Any = np.float32) -> npt.NDArray[Any]:
    """A property of all items of a collection; (items,), or (items, width) if it has several numbers."""
    array = np.empty(width * len(items), dtype=dtype)
    items.foreach_get(name, array)
    return array if width == 1 else array.reshape(-1, width)


def _properties(owner: bpy.types.bpy_struct) -> list[bpy.types.Property]:
    """Everything writable except what belongs to surfaces; a spline's type is set when it is made."""
    properties = (p for p in owner.bl_rna.properties if p.type in _TYPES and not p.is_readonly)
    return [p for p in properties if p.identifier != "type" and not p.identifier.endswith("_v")]


def kind(spline: bpy.types.Spline) -> str:
    """Name of a spline's type, as messages show it."""
    return _KINDS.get(spline.type, str(spline.type))


def smooth_splines(data: bpy.types.Curve) -> list[bpy.types.Spline]:
    """The splines that are not polygons yet."""
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
        # the chains of a mesh: vertices one after the other, each joined to the next
        mesh = bare.to_mesh()
        points, edges = read(mesh.vertices, "co", 3), read(mesh.edges, "vertices", 2, np.int32)
        low, high = np.sort(edges, axis=1).T
        starts = np.setdiff1d(np.arange(len(mesh.vertices)), high[high - low == 1])
        return np.split(points, starts[1:]) if len(starts) else []
    finally:
        bare.to_mesh_clear()
        bpy.data.objects.remove(bare)
        bpy.data.curves.remove(copy)
