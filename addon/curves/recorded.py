"""Shapes of curve objects in time: those of their keys, or the one that they have."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..engine.interpolation import along, interpolated
from ..engine.placement import Placement
from . import bake
from .exchange import closed, key_points, key_radii, read_splines
from .fcurves import fcurves_of
from .keyframes import coordinate_curves

if TYPE_CHECKING:
    import bpy

_LINEAR = "LINEAR"


@dataclass(frozen=True, eq=False)
class Recorded:
    """The shapes of one curve object, straight in between, in its own coordinates.

    Attributes
    ----------
    mesh
        Its splines as polygons, a component each.
    frames
        Scene frames of the shapes, (keys,); a curve that was not baked here has one shape at frame 0.
    points
        Vertices, (keys, n, 3).
    radii
        Their radii relative to the bevel depth, (keys, n).
    keys
        Vertices at shape keys, which may be at other frames, or at the last frame where there are none; (shapes, n, 3).
    """

    mesh: Mesh
    frames: FloatArray
    points: FloatArray
    radii: FloatArray
    keys: FloatArray

    @classmethod
    def of(cls, obj: "bpy.types.Object") -> "Recorded":
        """Read the splines of a curve object; raises CurveError if they cannot be read."""
        data = obj.data
        if not bake.is_baked(data):
            splines = read_splines(obj)
            mesh = Mesh(tuple(map(len, splines)), closed(data))
            radii = [_radii(spline, len(points)) for spline, points in zip(data.splines, splines, strict=True)]
            points = np.concatenate(splines)[None]
            return cls(mesh, np.zeros(1), points, np.concatenate(radii)[None], points)
        mesh = Mesh(tuple(len(spline.points) for spline in data.splines), closed(data))
        return cls(mesh, *(_from_shape_keys(data) if data.shape_keys else _from_fcurves(data)))

    def at(self, places: FloatArray) -> "Recorded":
        """The shapes at places among the keys, see `interpolated`."""
        frames, points, radii = (interpolated(array, places) for array in (self.frames, self.points, self.radii))
        return replace(self, frames=frames, points=points, radii=radii)


def in_world(
    objects: Sequence["bpy.types.Object"], recorded: Sequence[Recorded], shapes: Sequence[FloatArray]
) -> Curve:
    """Shapes of several objects as one link in world space; (n, 3) each."""
    components = [
        Placement.from_matrix(obj.matrix_world).to_world(points[piece])
        for obj, each, points in zip(objects, recorded, shapes, strict=True)
        for piece in each.mesh.slices
    ]
    return Curve.from_components(components, [flag for each in recorded for flag in each.mesh.closed])


def _shape_keys(data: "bpy.types.Curve") -> tuple[FloatArray, FloatArray]:
    """Vertices and relative radii of all shape keys; (keys, n, 3) and (keys, n)."""
    blocks = data.shape_keys.key_blocks
    points, radii = (np.stack([read(block) for block in blocks]) for read in (key_points, key_radii))
    return points.astype(np.float64), radii.astype(np.float64)


def _from_shape_keys(data: "bpy.types.Curve") -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    (curve,) = fcurves_of(data.shape_keys)
    frames = _frames([curve])
    points, radii = _shape_keys(data)
    place = np.array([curve.evaluate(frame) for frame in frames]).clip(0, len(points) - 1)
    return frames, interpolated(points, place), interpolated(radii, place), points


def _from_fcurves(data: "bpy.types.Curve") -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    curves = coordinate_curves(data)
    frames = _frames(curves)
    values = np.array([[curve.evaluate(frame) for curve in curves] for frame in frames])
    radii = np.concatenate([_radii(spline, len(spline.points)) for spline in data.splines])
    points = values.reshape(len(frames), -1, 3)
    return frames, points, np.tile(radii, (len(frames), 1)), points[-1:]


def _frames(curves: Sequence["bpy.types.FCurve"]) -> FloatArray:
    """Frames between which F-curves run straight: those of their keys, or all where somebody has bent them."""
    keys = [point for curve in curves for point in curve.keyframe_points]
    frames = np.unique([point.co[0] for point in keys])
    if any(point.interpolation != _LINEAR for point in keys):
        frames = np.union1d(frames[[0, -1]], np.arange(np.ceil(frames[0]), np.floor(frames[-1]) + 1))
    return np.asarray(frames, dtype=np.float64)


def _radii(spline: "bpy.types.Spline", size: int) -> FloatArray:
    """Radii at the points drawn for a spline."""
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    values = np.empty(len(points), dtype=np.float32)
    points.foreach_get("radius", values)
    return along(values, size, spline.use_cyclic_u)
