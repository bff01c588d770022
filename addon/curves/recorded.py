"""Curve objects over time: their shapes at their keys, or their only shape, and where these are in the world."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core import Curve
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..engine.interpolation import along, interpolated
from ..engine.placement import Placement
from . import bake
from .exchange import closed, key_points, key_radii, read_splines, stretch
from .keyframes import coordinate_curves, fcurves_of
from .moving import what_moves
from .splines import radii


@dataclass(frozen=True, eq=False)
class Recorded:
    """The shapes of one curve object, linear in between, in its own coordinates."""

    mesh: Mesh  # its splines as polygons, a component each
    frames: FloatArray  # scene frames of the shapes, (keys,); a curve that was not baked here has one shape at frame 0
    points: FloatArray  # vertices, (keys, n, 3)
    radii: FloatArray  # their radii relative to the bevel depth, (keys, n)
    # vertices at shape keys, which may be at other frames, or at the last frame where there are none; (shapes, n, 3)
    keys: FloatArray

    @classmethod
    def of(cls, obj: bpy.types.Object) -> "Recorded":
        """Read the splines of a curve object; raises CurveError if they cannot be read."""
        data = obj.data
        if not bake.is_baked(data):
            splines = read_splines(obj)
            mesh, points = Mesh(tuple(map(len, splines)), closed(data)), np.concatenate(splines)[None]
            return cls(mesh, np.zeros(1), points, _radii(data, mesh)[None], points)
        mesh = Mesh(tuple(len(spline.points) for spline in data.splines), closed(data))
        return cls(mesh, *(_from_shape_keys(data) if data.shape_keys else _from_fcurves(data, mesh)))

    def at(self, places: FloatArray) -> "Recorded":
        """The shapes at places among the keys, see `interpolated`."""
        frames, points, thickness = (interpolated(array, places) for array in (self.frames, self.points, self.radii))
        return replace(self, frames=frames, points=points, radii=thickness)


def in_world(objects: Sequence[bpy.types.Object], recorded: Sequence[Recorded], shapes: Sequence[FloatArray]) -> Curve:
    """Shapes of several objects as one link in world space; (n, 3) each."""
    components = [
        Placement.from_matrix(obj.matrix_world).to_world(points[piece])
        for obj, each, points in zip(objects, recorded, shapes, strict=True)
        for piece in each.mesh.slices
    ]
    return Curve.from_components(components, [flag for each in recorded for flag in each.mesh.closed])


def _from_shape_keys(data: bpy.types.Curve) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    (curve,) = fcurves_of(data.shape_keys)
    frames, blocks = _frames([curve]), data.shape_keys.key_blocks
    points, thickness = (
        np.stack([read(block) for block in blocks]).astype(np.float64) for read in (key_points, key_radii)
    )
    place = np.array([curve.evaluate(frame) for frame in frames]).clip(0, len(points) - 1)
    return frames, interpolated(points, place), interpolated(thickness, place), points


def _from_fcurves(data: bpy.types.Curve, mesh: Mesh) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    curves = coordinate_curves(data)
    frames = _frames(curves)
    values = np.array([[curve.evaluate(frame) for curve in curves] for frame in frames])
    points = values.reshape(len(frames), -1, 3)
    return frames, points, np.tile(_radii(data, mesh), (len(frames), 1)), points[-1:]


def _frames(curves: Sequence[bpy.types.FCurve]) -> FloatArray:
    """Frames between which F-curves run straight: those of their keys, or all where somebody has bent them."""
    keys = [point for curve in curves for point in curve.keyframe_points]
    frames = np.unique([point.co[0] for point in keys])
    if any(point.interpolation != "LINEAR" for point in keys):
        frames = np.union1d(frames[[0, -1]], np.arange(np.ceil(frames[0]), np.floor(frames[-1]) + 1))
    return np.asarray(frames, dtype=np.float64)


def _radii(data: bpy.types.Curve, mesh: Mesh) -> FloatArray:
    """Radii at the points drawn for all splines."""
    pieces = zip(data.splines, mesh.component_sizes, strict=True)
    return np.concatenate([along(radii(spline), size, spline.use_cyclic_u) for spline, size in pieces])


@dataclass(frozen=True, eq=False)
class WorldMotion:
    """Curve objects over time; between frames, points move straight, or nearly so if something moves the objects."""

    frames: FloatArray  # ascending scene frames; (frames,)
    points: list[FloatArray]  # points of all objects at each of them; (n, 3)
    radii: FloatArray  # radius of the thickest tube at each of them; (frames,)

    @classmethod
    def of(cls, scene: bpy.types.Scene, objects: Sequence[bpy.types.Object]) -> "WorldMotion":
        """Sample curve objects at all their keys; where something moves them, at all frames of the scene too.

        Modifiers are ignored. Raises CurveError if splines cannot be read.
        """
        recorded = [Recorded.of(obj) for obj in objects]
        moving = any(what_moves(obj) for obj in objects)
        keyed = [each.frames for each in recorded if len(each.frames) > 1]
        every = [np.arange(scene.frame_start, scene.frame_end + 1, dtype=np.float64)] if moving else []
        frames = np.unique(np.concatenate([*keyed, *every] or [np.array([float(scene.frame_start)])]))
        placements = _placements(scene, objects, frames if moving else frames[:1])
        points, thickness = [], []
        for obj, each in zip(objects, recorded, strict=True):
            shown = each.at(np.interp(frames, each.frames, np.arange(len(each.frames))))
            there = placements[obj.name] if moving else placements[obj.name] * len(frames)
            points.append([place.to_world(shape) for place, shape in zip(there, shown.points, strict=True)])
            thickness.append(drawn_radius(obj) * shown.radii.max(axis=1))
        return cls(frames, [np.concatenate(shapes) for shapes in zip(*points, strict=True)], np.max(thickness, axis=0))


def _placements(
    scene: bpy.types.Scene, objects: Sequence[bpy.types.Object], frames: FloatArray
) -> dict[str, list[Placement]]:
    """Places of objects by their names, at each of some frames; for a single frame, as they are now."""
    found: dict[str, list[Placement]] = {obj.name: [] for obj in objects}
    shown, subframe = scene.frame_current, scene.frame_subframe
    try:
        for frame in frames:
            if len(frames) > 1:
                scene.frame_set(int(frame // 1), subframe=float(frame % 1))
            for obj in objects:
                found[obj.name].append(Placement.from_matrix(obj.matrix_world))
    finally:
        if (scene.frame_current, scene.frame_subframe) != (shown, subframe):
            scene.frame_set(shown, subframe=subframe)
    return found


def drawn_radius(obj: bpy.types.Object) -> float:
    """How far what is drawn around an object's curve reaches from it where the radius is 1, in the world."""
    data = obj.data
    return float((data.bevel_depth + data.extrude + abs(data.offset)) * stretch(obj))
