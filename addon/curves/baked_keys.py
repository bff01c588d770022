"""The keys of baked curve objects, read, changed and written back, and what is proved of the motions between them."""

from collections.abc import Sequence
from itertools import pairwise

import bpy
import numpy as np

from ...core import Curve, MobiusFlowError
from ...core.collision import is_free
from ...core.curve import Mesh
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.placement import Frame, Link, Placement
from ..engine.size import Measure, Size
from ..engine.words import named
from . import bake, pins
from .exchange import closed, key_points, write_points
from .keyframes import coordinate_curves, scale_radii
from .splines import read


class BakedKeys:
    """What baked curve objects, their transforms evaluated, are at each of their keys; ``frames``: as stored, (n, 3).

    Raises MobiusFlowError if they have not equally many keys, so that they were not baked together.
    """

    def __init__(self, objects: Sequence[bpy.types.Object]) -> None:
        self._objects = objects
        sizes = [[len(spline.points) for spline in obj.data.splines] for obj in objects]
        open_too = tuple(flag for obj in objects for flag in closed(obj.data))
        self.mesh = Mesh(tuple(size for each in sizes for size in each), open_too)
        placements = tuple(Placement.from_matrix(obj.matrix_world) for obj in objects)
        self.link = Link(placements, tuple(map(len, sizes)))
        keys = [keyed_points(obj.data) for obj in objects]
        if len({len(each) for each in keys}) > 1:
            title = named([obj.name for obj in objects])
            raise MobiusFlowError(Message("{names} were not baked together; select one of them at a time", names=title))
        self.frames: list[Frame] = [np.concatenate(each) for each in zip(*keys, strict=True)]

    @property
    def curves(self) -> list[Curve]:
        """The link at each key, in the world."""
        pieces = list(zip(self.link.placements, self.link.slices(self.mesh), strict=True))
        stored = [frame.astype(np.float64) for frame in self.frames]
        world = [np.concatenate([place.to_world(points[s]) for place, s in pieces]) for points in stored]
        return [Curve(points, self.mesh) for points in world]

    def rewrite(self, curves: Sequence[Curve], factors: FloatArray | None = None) -> None:
        """Give the keys other shapes, in the world, and what is drawn around them other sizes, by factors, (keys,)."""
        self.frames = [self.link.to_stored(self.mesh, curve.vertices).astype(np.float32) for curve in curves]
        for obj, vertices in zip(self._objects, self.link.slices(self.mesh), strict=True):
            _move_keys(obj.data, [frame[vertices] for frame in self.frames])
            if factors is not None and obj.data.shape_keys:
                scale_radii(obj.data, factors)
            elif factors is not None:  # only points are keyed
                bake.scale_bevel(obj.data, float(factors[-1]))
            bake.update(obj.data)

    @property
    def unproved(self) -> int:
        """Number of straight motions from key to key, as stored, that are not proved free of contact."""
        common = [self.link.to_common(self.mesh, frame) for frame in self.frames]
        return sum(not is_free(self.mesh, a, b) for a, b in pairwise(common))


def keep_size(objects: Sequence[bpy.types.Object], measure: Measure, reference: int) -> BakedKeys:
    """Scale all keys about their barycenters to the size of one of them, and the tubes drawn around them alike.

    `engine.size` says why that makes no contact; what the rounded keys are is to be proved once more. Raises
    MobiusFlowError if the objects were not baked together, or points of them are pinned.
    """
    if any(pins.count(obj.data) for obj in objects):
        raise MobiusFlowError(Message("Scaling would move pinned points; unpin them first"))
    keys = BakedKeys(objects)
    curves = keys.curves
    size = Size.of(measure, curves[reference])
    keys.rewrite([size.given_to(curve) for curve in curves], np.array([size.factor(curve) for curve in curves]))
    return keys


def keyed_points(data: bpy.types.Curve) -> list[Frame]:
    """Points of a curve at each of its keys, (n, 3)."""
    if data.shape_keys:
        return [key_points(block) for block in data.shape_keys.key_blocks]
    columns = [_keys_of(curve)[:, 1] for curve in coordinate_curves(data)]
    if len({len(column) for column in columns}) > 1:
        raise MobiusFlowError(Message("Keys of '{name}' were edited; undo that, or Bake Again", name=data.name))
    return list(np.stack(columns, axis=1).reshape(len(columns[0]), -1, 3))


def _move_keys(data: bpy.types.Curve, frames: Sequence[Frame]) -> None:
    """Move the points at each key, (n, 3), and leave its time; the curve itself gets those of the last one."""
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


def _keys_of(curve: bpy.types.FCurve) -> Frame:
    """Frames and values; shape (keys, 2)."""
    return read(curve.keyframe_points, "co", 2)
