"""The keys of baked curve objects, read, changed, turned and written back, and what is proved between them."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import bpy
import numpy as np
from mathutils import Matrix

from ...core import Curve, MobiusFlowError
from ...core.collision import is_free
from ...core.curve import Mesh
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.placement import Frame, Link, Placement, Turn, orthonormal
from ..engine.size import Measure, Size
from ..engine.words import named
from . import bake, pins
from .exchange import closed, key_points, read_link, write_points
from .keyframes import coordinate_curves, scale_radii
from .moving import what_moves
from .splines import read

_SQUARE = 1e-5  # cosines below which angles count as right: Blender's matrices are rounded


class BakedKeys:
    """Baked curve objects, their transforms evaluated, at each of their keys; ``frames``: points as stored, (n, 3).

    Raises MobiusFlowError if their numbers of keys differ: then they were not baked together.
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
        """Give the keys new shapes, in the world, and scale what is drawn around them by factors, (keys,)."""
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

    `engine.size` says why that makes no contact; the motion between the rounded keys has to be proved again. Raises
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
    """Move the points at each key, (n, 3), but not the key in time; the curve itself gets the last key's points."""
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


def lay_flat(objects: Sequence[bpy.types.Object]) -> int:
    """Turn curves so that they extend least upwards; one that is animated, least along its own Z axis.

    Returns the number of motions of keys that are not proved any more. Raises MobiusFlowError if something moves one
    of them, or its parent's scale would shear it, and it is not alone, or has no keys; or if all points are the same.
    """
    flat = np.array(objects[0].matrix_world, dtype=np.float64)[:3, :3].T if what_moves(objects[0]) else np.eye(3)
    return _turn(objects, orthonormal(flat))


def face_camera(objects: Sequence[bpy.types.Object], camera: bpy.types.Object) -> int:
    """Turn curves so that a camera sees their widest side, its longest axis across the picture; as `lay_flat`."""
    view = np.array(camera.matrix_world, dtype=np.float64)
    axes = view[:3, :3].T.copy()
    if camera.data.type != "ORTHO":
        axes[2] = view[:3, 3] - Turn.onto(_shape(objects), np.eye(3)).center
    return _turn(objects, orthonormal(axes))


def _turn(objects: Sequence[bpy.types.Object], wanted: FloatArray) -> int:
    turn = Turn.onto(_shape(objects), wanted)
    if why := next((why for obj in objects for why in _obstacles(obj, objects, turn)), None):
        if len(objects) > 1 or not bake.is_baked(objects[0].data):
            raise MobiusFlowError(Message("{why}; remove that, or bake it and turn it alone", why=why))
        if bake.is_edited(objects[0].data):
            raise MobiusFlowError(Message("{why}, and its keys were edited; undo one or the other", why=why))
        keys = BakedKeys(objects)
        keys.rewrite([turn.of(curve) for curve in keys.curves])
        return keys.unproved
    turned = {obj: Matrix(turn.matrix.tolist()) @ obj.matrix_world for obj in objects}
    for obj in sorted(objects, key=lambda each: sum(1 for _ in _ancestors(each))):  # parents carry their children along
        obj.matrix_world = turned[obj]
        bpy.context.view_layer.update()
    # a single object may go anywhere; the positions of several relative to each other are rounded anew
    proved = len(objects) > 1 and all(bake.is_baked(obj.data) for obj in objects)
    return BakedKeys(objects).unproved if proved else 0


def _obstacles(obj: bpy.types.Object, objects: Sequence[bpy.types.Object], turn: Turn) -> Iterator[Message]:
    if mover := what_moves(obj):
        yield Message("'{name}' is moved by {mover}", name=obj.name, mover=mover)
    elif obj.parent and not any(each in objects for each in _ancestors(obj)) and _shears(obj, turn):
        yield Message("'{name}' would change its shape, as its parent's scale is uneven", name=obj.name)


def _shears(obj: bpy.types.Object, turn: Turn) -> bool:
    """Whether no location, rotation and scale under an object's parent give the turned object."""
    matrix, own = (np.array(each, dtype=np.float64)[:3, :3] for each in (obj.matrix_world, obj.matrix_basis))
    parental = matrix @ np.linalg.inv(own)
    columns = np.linalg.solve(parental, turn.rotation @ matrix)
    columns /= np.linalg.norm(columns, axis=0)
    return not np.allclose(columns.T @ columns, np.eye(3), atol=_SQUARE)


def _shape(objects: Sequence[bpy.types.Object]) -> Curve:
    """The curves in the world, at the end of their animation if they are baked."""
    if all(bake.is_baked(obj.data) for obj in objects):
        return BakedKeys(objects).curves[-1]
    return read_link(objects)[0]


def _ancestors(obj: bpy.types.Object) -> Iterator[bpy.types.Object]:
    while obj.parent is not None:
        yield (obj := obj.parent)
