"""Curve objects converted to polygons in world space, and back, whatever the object's transform."""

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np

from ...core import Curve, CurveError, Mesh
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.placement import Frame, Link, Placement
from .splines import coordinates, read, sampled, smooth_splines

_FAR = 1e30  # Blender clamps infinite coordinates to the largest 32-bit number


def read_link(objects: Sequence[bpy.types.Object]) -> tuple[Curve, Link]:
    """Read the splines of curve objects in world space, one component each, and where they are stored.

    Splines that are not cyclic are open components, smooth ones the polygons drawn for them. Raises CurveError if a
    coordinate is not finite, or as good as infinite, or no polygon is drawn.
    """
    placements = tuple(Placement.from_matrix(obj.matrix_world) for obj in objects)
    components = [read_splines(obj) for obj in objects]
    link = Link(placements, tuple(len(each) for each in components))
    world = [placement.to_world(c) for placement, each in zip(placements, components, strict=True) for c in each]
    return Curve.from_components(world, [flag for obj in objects for flag in closed(obj.data)]), link


def closed(data: bpy.types.Curve) -> tuple[bool, ...]:
    """Whether each spline is closed; those that are not cyclic are open."""
    return tuple(bool(spline.use_cyclic_u) for spline in data.splines)


def read_splines(obj: bpy.types.Object) -> list[FloatArray]:
    """The polygons of all splines in the object's coordinates, (n, 3) each; raises as `read_link` does."""
    smooth = smooth_splines(obj.data)
    frames = sampled(obj) if smooth else [coordinates(spline) for spline in obj.data.splines]
    for k, frame in enumerate(frames, 1):
        bad = np.flatnonzero(~(np.abs(frame) < _FAR).all(axis=1))
        if bad.size:
            sentence = (
                "Point {point} of spline {spline} of '{name}' is not finite, or further away than anything; repair or"
                " delete it"
            )
            raise CurveError(Message(sentence, point=bad[0] + 1, spline=k, name=obj.name))
    return [frame.astype(np.float64) for frame in frames]


def stretch(obj: bpy.types.Object) -> float:
    """The largest factor by which an object's coordinates are stretched on the way to the world."""
    return float(np.linalg.norm(np.array(obj.matrix_world)[:3, :3], 2))


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


def key_points(block: bpy.types.ShapeKey) -> Frame:
    """Coordinates of all points at a shape key; shape (n, 3)."""
    return read(block.data, "co", 3)


def key_radii(block: bpy.types.ShapeKey) -> Frame:
    """Radii of all points at a shape key, relative to the bevel depth; shape (n,)."""
    return read(block.data, "radius")


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
