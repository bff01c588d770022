"""Keys that are there already: the points at each of them, read, and moved without a change of their times."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core import MobiusFlowError
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.placement import Frame
from . import bake
from .exchange import key_points, key_radii, write_points
from .keyframes import coordinate_curves

if TYPE_CHECKING:
    import bpy


def keyed_points(data: "bpy.types.Curve") -> list[Frame]:
    """Points of a curve at each of its keys, (n, 3).

    Raises
    ------
    MobiusFlowError
        If somebody has added or removed keys of some of its coordinates.
    """
    if data.shape_keys:
        return [key_points(block) for block in data.shape_keys.key_blocks]
    columns = [_keys_of(curve)[:, 1] for curve in coordinate_curves(data)]
    if len({len(column) for column in columns}) > 1:
        raise MobiusFlowError(Message("Keys of '{name}' were edited; undo that, or Bake Again", name=data.name))
    return list(np.stack(columns, axis=1).reshape(len(columns[0]), -1, 3))


def move_keys(data: "bpy.types.Curve", frames: Sequence[Frame]) -> None:
    """Move the points at each key, (n, 3); the curve itself gets those of the last one."""
    if data.shape_keys:
        for block, frame in zip(data.shape_keys.key_blocks, frames, strict=True):
            block.data.foreach_set("co", frame.ravel())
    else:
        values = np.stack(frames).reshape(len(frames), -1)
        for curve, column in zip(coordinate_curves(data), values.T, strict=True):
            places = _keys_of(curve)
            places[:, 1] = column
            curve.keyframe_points.foreach_set("co", places.ravel())
            curve.update()
    write_points(data, frames[-1])


def scale_tube(data: "bpy.types.Curve", factors: FloatArray) -> None:
    """Scale what is drawn around a curve by a factor for each key; where only points are keyed, by the last of them."""
    if not data.shape_keys:
        bake.scale_bevel(data, float(factors[-1]))
        return
    for block, factor in zip(data.shape_keys.key_blocks, factors, strict=True):
        block.data.foreach_set("radius", key_radii(block) * np.float32(factor))


def _keys_of(curve: "bpy.types.FCurve") -> Frame:
    """Frames and values; shape (keys, 2)."""
    places = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
    curve.keyframe_points.foreach_get("co", places)
    return places.reshape(-1, 2)
