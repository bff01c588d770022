"""The splines of curve data: copied with all settings of theirs and of their points, made into polygons, compared."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

from ...core import Curve, CurveError, Mesh
from ...core.base import FloatArray, Message
from ...core.keys.markers import along, on_refined
from ...core.keys.placement import Frame

SOURCE = "mobius_flow_source"  # custom property of curve data that carries the keys of an object of another kind
_TYPES: dict[str, Any] = {"BOOLEAN": np.int32, "INT": np.int32, "FLOAT": np.float32, "ENUM": np.int32}


@dataclass(frozen=True, eq=False)
class _Spline:
    """One spline: its own settings, and an array for every setting of its points."""

    type: str
    count: int
    settings: dict[str, Any]
    points: dict[str, npt.NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Splines:
    """Copies of all splines of curve data."""

    each: Sequence[_Spline]
    active: int | None

    @classmethod
    def of(cls, data: bpy.types.Curve) -> "Splines":
        active = next((k for k, spline in enumerate(data.splines) if spline == data.splines.active), None)
        each = []
        for spline in data.splines:
            points, arrays = control_points(spline), {}
            for prop in _properties(points[0]) if len(points) else ():
                width = max(getattr(prop, "array_length", 1), 1)  # only vectors have several numbers
                arrays[prop.identifier] = read(points, prop.identifier, width, _TYPES[prop.type])
            settings = {prop.identifier: getattr(spline, prop.identifier) for prop in _properties(spline)}
            if spline.type != "NURBS":
                del settings["order_u"]  # means nothing, and is made valid when it is set
            each.append(_Spline(spline.type, len(points), settings, arrays))
        return cls(each, active)

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
                for name in ("radius", "tilt", "weight_softbody")
            }
            settings = {name: value for name, value in spline.settings.items() if name != "order_u"}
            made.append(_Spline("POLY", refined.mesh.component_sizes[k], settings, points))
        return Splines(made, self.active)

    def fill(self, data: bpy.types.Curve) -> None:
        """Give these splines to curve data in place of its own."""
        data.splines.clear()
        for each in self.each:
            spline = data.splines.new(each.type)
            points = control_points(spline)
            points.add(each.count - len(points))
            for name, array in each.points.items():
                points.foreach_set(name, array.ravel())
            for name, value in each.settings.items():
                setattr(spline, name, value)
        if self.active is not None:
            data.splines.active = data.splines[self.active]
        data.update_tag()


def shape(data: bpy.types.Curve) -> list[tuple[int, str, bool]]:
    """The splines apart from the positions of their points: their number, the type, and whether it is closed."""
    return [(len(control_points(each)), each.type, bool(each.use_cyclic_u)) for each in data.splines]


def mesh_of(*every: bpy.types.Curve) -> Mesh:
    """The polygons of curve data of poly splines, one after the other."""
    sizes, _, flags = zip(*(each for data in every for each in shape(data)), strict=True)
    return Mesh(sizes, flags)


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


def depth(data: bpy.types.Curve) -> float:
    """Radius of what is drawn around a curve where a point's own is 1; hair is as thick as its points say."""
    return 1.0 if SOURCE in data else float(data.bevel_depth)


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
    return {"BEZIER": "Bézier"}.get(spline.type, str(spline.type))


def smooth_splines(data: bpy.types.Curve) -> list[bpy.types.Spline]:
    """The splines that are not polygons yet."""
    return [spline for spline in data.splines if spline.type != "POLY"]


def questions(objects: Sequence[bpy.types.Object]) -> list[str]:
    """Ask whether the smooth splines of objects may become polygons, a line each; raises as `sampled` does."""
    smooth, lines, most = [obj for obj in objects if smooth_splines(obj.data)], list[str](), 5
    for obj in smooth[:most]:
        drawn = zip(sampled(obj), obj.data.splines, strict=True)
        points = sum(len(points) for points, spline in drawn if spline.type != "POLY")
        kinds = "/".join(sorted({kind(spline) for spline in smooth_splines(obj.data)}))
        sentence = "{kinds} splines of '{name}' become polygons, of {points} points in all"
        lines.append(Message(sentence, kinds=kinds, name=obj.name, points=points))
    if len(smooth) > most:
        lines.append(Message("{count} more objects have smooth splines too", count=len(smooth) - most))
    return lines


def sampled(obj: bpy.types.Object) -> list[Frame]:
    """Points of all splines, each of shape (n, 3): smooth ones as drawn, at their own preview resolution.

    Raises CurveError if no polygon is drawn for a spline.
    """
    copy = obj.data.copy()  # the line itself, without all that is drawn around it
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
        starts = np.setdiff1d(np.arange(len(points)), high[high - low == 1])
        loops = np.split(points, starts[1:]) if len(starts) else []
    finally:
        bare.to_mesh_clear()
        bpy.data.objects.remove(bare)
        bpy.data.curves.remove(copy)
    if len(loops) != len(obj.data.splines):
        sentence = "'{name}' has splines that Blender draws nothing for; delete them, or convert all to Poly first"
        raise CurveError(Message(sentence, name=obj.name))
    sentence = (
        "Spline {number} of '{name}' is drawn with only {count} points; raise its Resolution U, or give it more points"
    )
    for k, (loop, spline) in enumerate(zip(loops, obj.data.splines, strict=True), 1):
        if len(loop) < (3 if spline.use_cyclic_u else 2):
            raise CurveError(Message(sentence, number=k, name=obj.name, count=len(loop)))
    return loops


def box(obj: bpy.types.Object) -> tuple[FloatArray, FloatArray]:
    """The least and the greatest coordinates of the corners of an object's box in the world."""
    matrix = np.array(obj.matrix_world)
    with np.errstate(invalid="ignore"):  # where points are not finite
        corners = np.array(obj.bound_box) @ matrix[:3, :3].T + matrix[:3, 3]
    return corners.min(axis=0), corners.max(axis=0)


def length(scene: bpy.types.Scene, value: float) -> str:
    """Format a length with its unit, to about four digits."""
    units = scene.unit_settings
    text = bpy.utils.units.to_string(
        units.system, "LENGTH", value * units.scale_length, precision=4, split_unit=units.use_separate
    )
    return str(text).strip()


def write_points(data: bpy.types.Curve, frame: Frame) -> None:
    """Move the points of all splines; shape (n, 3), the object's coordinates."""
    first = 0
    for spline in data.splines:
        count = len(spline.points)
        points = np.ones((count, 4), dtype=np.float32)
        points[:, :3] = frame[first : first + count]
        spline.points.foreach_set("co", points.ravel())
        first += count
    data.update_tag()


def new_curve_data(name: str, mesh: Mesh) -> bpy.types.Curve:
    """Make curve data of poly splines, one for each component, with all points still at the origin."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    for size, is_closed in zip(mesh.component_sizes, mesh.closed, strict=True):
        spline = data.splines.new("POLY")
        spline.points.add(size - 1)
        spline.use_cyclic_u = is_closed
    return data


class Reference:
    """An object or curve data, whatever it is called now; after undo, Python's own references dangle."""

    def __init__(self, block: bpy.types.ID) -> None:
        self.name = block.name  # when it was last looked up
        self._uid, self._blocks = block.session_uid, "objects" if block.id_type == "OBJECT" else "curves"

    def get(self) -> Any:
        """The datablock, or None if it is gone; it is looked up by its last name first, as there may be thousands."""
        blocks = getattr(bpy.data, self._blocks)
        block = blocks.get(self.name)
        if block is None or block.session_uid != self._uid:
            block = next((block for block in blocks if block.session_uid == self._uid), None)
        if block is not None:
            self.name = block.name
        return block
