"""A camera that follows a moving curve gently, and a floor that stays below it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ...core.types import FloatArray
from ..curves.fcurves import FCurves
from ..engine.placement import Frame
from .stage import Stage, add, place

if TYPE_CHECKING:
    import bpy

_ELEVATION = np.radians(62.0)
_LENS = 60.0  # mm
_SENSOR = 36.0  # mm
_MARGIN = 1.14
_CALM = 25  # frames over which the camera's way is smoothed
_LIFT = 1.02  # of the tube's radius: how far the lowest point stays above the floor


def follow(
    collection: "bpy.types.Collection",
    size: tuple[float, float],
    stage: Stage,
    floor: "bpy.types.Object",
    points: "Sequence[Frame | FloatArray]",
    radii: FloatArray,
    frames: FloatArray,
) -> "bpy.types.Object":
    """Add a camera that sees the whole tube in every frame, and keep the floor just below it.

    ``size`` is that of its pictures, in any unit; the floor is at the height of the stage's middle; points are the
    vertices, (n, 3), of every key.
    """
    import bpy

    axes = _view_axes(stage)
    data = bpy.data.cameras.new("Camera")
    data.lens, data.sensor_width = _LENS, _SENSOR
    camera = add(collection, "Camera", data)
    place(camera, stage.middle + axes[2], stage.middle, stage.axes[2])
    every = np.arange(np.floor(frames[0]), np.ceil(frames[-1]) + 1)
    seen = [(p - stage.middle) @ axes.T for p in points]
    slopes = 0.5 * _SENSOR / _LENS * np.array(size) / max(size)  # tangents of half the angles of view
    eyes = _eyes(seen, radii, slopes / _MARGIN, frames, every)
    heights = np.array([((p - stage.middle) @ stage.axes[2]).min() for p in points]) - _LIFT * radii
    lows = -_calm(-np.interp(every, frames, heights))
    _move(camera, stage.middle + eyes @ axes, every)
    _move(floor, stage.middle + lows[:, None] * stage.axes[2], every)
    distances = eyes[:, 2]
    data.clip_start, data.clip_end = 1e-2 * distances.min(), 1e2 * distances.max()
    return camera


def _view_axes(stage: Stage) -> FloatArray:
    """Right, up and backward of the camera, which looks down on the stage; rows."""
    backward = np.array([0.0, -np.cos(_ELEVATION), np.sin(_ELEVATION)]) @ stage.axes
    return np.array([stage.axes[0], np.cross(backward, stage.axes[0]), backward])


def _eyes(
    seen: Sequence[FloatArray], radii: FloatArray, slopes: FloatArray, frames: FloatArray, every: FloatArray
) -> FloatArray:
    """Places of a camera that looks along −z in every frame, all in its own directions; shape (frames, 3).

    Seen from depth d, a point is inside the picture if |x − c| ≤ s (d − z). The outermost points give the best
    centre c; then follows the depth that a calmly moving c needs. Both are right between keys too, where points
    move straight: what a point needs is a convex function of where it is.
    """
    reaches = [p[:, 2:] * slopes + r * np.sqrt(1 + slopes**2) for p, r in zip(seen, radii, strict=True)]
    sides = [((p[:, :2] + a).max(axis=0), (p[:, :2] - a).min(axis=0)) for p, a in zip(seen, reaches, strict=True)]
    high, low = (np.array(side) for side in zip(*sides, strict=True))
    centres = _each(0.5 * (high + low), frames, every)
    centres = uniform_filter1d(centres, _CALM, axis=0, mode="nearest")
    needed = np.maximum(_each(high, frames, every) - centres, centres - _each(low, frames, every)) / slopes
    return np.column_stack([centres, _calm(needed.max(axis=1))])


def _each(values: FloatArray, frames: FloatArray, every: FloatArray) -> FloatArray:
    return np.column_stack([np.interp(every, frames, column) for column in values.T])


def _calm(values: FloatArray) -> FloatArray:
    """A smooth upper bound of values in consecutive frames: the mean of the largest nearby."""
    return np.asarray(uniform_filter1d(maximum_filter1d(values, _CALM, mode="nearest"), _CALM, mode="nearest"))


def _move(obj: "bpy.types.Object", places: FloatArray, frames: FloatArray) -> None:
    """Put an object where it is in the first frame, and let it move if it does."""
    obj.location = places[0]
    if len(places) > 1 and np.ptp(places, axis=0).max() > 0:
        curves = FCurves(obj, f"{obj.name} Motion")
        for axis in range(3):
            curves.add("location", axis, frames, places[:, axis])
