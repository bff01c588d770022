"""A camera that follows a moving curve gently, and a floor that stays below it."""

from collections.abc import Sequence

import bpy
import mathutils
import numpy as np
from mathutils import Matrix
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ...core.types import FloatArray
from ..curves.fcurves import FCurves
from ..engine.interpolation import interpolated
from ..engine.placement import Frame
from .stage import Stage, add

_LENS = 60.0  # mm
_SENSOR = 36.0  # mm
_CALM = 25  # frames over which the camera's way is smoothed
_LIFT = 1.02  # of the tube's radius: how far the lowest point stays above the floor
_ORBIT = np.radians(24.0)  # to either side, once in a film
_APERTURE = 0.03  # width of the lens in sizes of the stage: what is a size off the focus is softened by so much


def follow(
    collection: bpy.types.Collection,
    size: tuple[float, float],
    stage: Stage,
    floor: bpy.types.Object,
    points: "Sequence[Frame | FloatArray]",
    radii: FloatArray,
    frames: FloatArray,
) -> bpy.types.Object:
    """Add a camera that sees the whole tube in every frame, and keep the floor just below it.

    It swings around the stage, looks at an empty and is focused there. ``size`` is that of its pictures, in any unit;
    the floor is at the height of the stage's middle; points are the vertices, (n, 3), of every key.
    """
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width = _LENS, _SENSOR
    camera, focus = add(collection, "Camera", data), add(collection, "Focus", None)
    every = np.arange(np.floor(frames[0]), np.ceil(frames[-1]) + 1)
    slopes = 0.5 * _SENSOR / _LENS * np.array(size) / max(size)  # tangents of half the angles of view
    stacked, places = np.stack(points).astype(np.float64), np.interp(every, frames, np.arange(len(frames)))
    shapes = [(interpolated(stacked, at[None])[0] - stage.middle) @ stage.axes.T for at in places]
    views = [_view(stage.elevation, turn) for turn in _ORBIT * np.sin(np.linspace(0.0, 2.0 * np.pi, len(every)))]
    targets, distances = _targets(shapes, np.interp(every, frames, radii), slopes / stage.margin, views)
    heights = np.array([((p - stage.middle) @ stage.axes[2]).min() for p in points]) - _LIFT * radii
    lows = -_calm(-np.interp(every, frames, heights))
    _move(focus, stage.middle + targets @ stage.axes, every)
    _move(camera, stage.middle + (targets + distances[:, None] * np.array(views)[:, 2]) @ stage.axes, every)
    _move(floor, stage.middle + lows[:, None] * stage.axes[2], every)
    focus.rotation_euler, focus.empty_display_size = _euler(stage.axes), 0.1 * stage.size
    look = camera.constraints.new("TRACK_TO")
    look.target, look.track_axis, look.up_axis, look.use_target_z = focus, "TRACK_NEGATIVE_Z", "UP_Y", True
    data.clip_start, data.clip_end = 1e-2 * distances.min(), 1e2 * distances.max()
    data.dof.use_dof, data.dof.focus_object = True, focus
    data.dof.aperture_fstop = 1e-3 * _LENS / (_APERTURE * stage.size)  # a lens is measured in millimetres
    return camera


def _view(elevation: float, turn: float) -> FloatArray:
    """Right, up and backward, in a stage's axes, of a camera that looks down on it; rows."""
    right = np.array([np.cos(turn), np.sin(turn), 0.0])
    backward = np.array([np.cos(elevation) * np.sin(turn), -np.cos(elevation) * np.cos(turn), np.sin(elevation)])
    return np.array([right, np.cross(backward, right), backward])


def _targets(
    shapes: Sequence[FloatArray], radii: FloatArray, slopes: FloatArray, views: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Where cameras look in every frame, (frames, 3), and their distances from there, (frames,); in the shapes' axes.

    Seen from distance d, a point is inside the picture if |x − c| ≤ s (d − z). The outermost points give the best
    centre c, and then the distance that a calmly moving c needs.
    """
    reaches = radii[:, None] * np.sqrt(1 + slopes**2)
    seen = [shape @ view.T for shape, view in zip(shapes, views, strict=True)]
    high = [(p[:, :2] + p[:, 2:] * slopes + r).max(axis=0) for p, r in zip(seen, reaches, strict=True)]
    low = [(p[:, :2] - p[:, 2:] * slopes - r).min(axis=0) for p, r in zip(seen, reaches, strict=True)]
    centres = [0.5 * (a + b) @ view[:2] for a, b, view in zip(high, low, views, strict=True)]
    targets = uniform_filter1d(np.array(centres), _CALM, axis=0, mode="nearest")
    looked = np.array([view @ target for view, target in zip(views, targets, strict=True)])
    needed = np.maximum(high - looked[:, :2], looked[:, :2] - low) / slopes - looked[:, 2:]
    return targets, _calm(needed.max(axis=1))


def _euler(axes: FloatArray) -> mathutils.Euler:
    """The rotation that turns the world's axes into others, rows."""
    return Matrix(axes.T.tolist()).to_euler()


def _calm(values: FloatArray) -> FloatArray:
    """A smooth upper bound of values in consecutive frames: the mean of the largest nearby."""
    return np.asarray(uniform_filter1d(maximum_filter1d(values, _CALM, mode="nearest"), _CALM, mode="nearest"))


def _move(obj: bpy.types.Object, places: FloatArray, frames: FloatArray) -> None:
    """Put an object where it is in the first frame, and let it move if it does."""
    obj.location = places[0]
    if len(places) > 1 and np.ptp(places, axis=0).max() > 0:
        curves = FCurves(obj, f"{obj.name} Motion")
        for axis in range(3):
            curves.add("location", axis, frames, places[:, axis])
