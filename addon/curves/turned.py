"""Curve objects turned as one rigid body, or their keys where something else turns the object."""

from collections.abc import Iterator, Sequence

import bpy
import numpy as np
from mathutils import Matrix

from ...core import Curve, MobiusFlowError
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.turning import Turn, orthonormal
from . import bake
from .baked_keys import BakedKeys
from .exchange import read_link
from .moving import what_moves

_SQUARE = 1e-5  # cosines of angles that are right but for the rounding of Blender's matrices


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
    # a single object goes wherever it likes; places of several against each other are rounded anew
    proved = len(objects) > 1 and all(bake.is_baked(obj.data) for obj in objects)
    return BakedKeys(objects).unproved if proved else 0


def _obstacles(obj: bpy.types.Object, objects: Sequence[bpy.types.Object], turn: Turn) -> Iterator[Message]:
    if mover := what_moves(obj):
        yield Message("'{name}' is moved by {mover}", name=obj.name, mover=mover)
    elif obj.parent and not any(each in objects for each in _ancestors(obj)) and _shears(obj, turn):
        yield Message("'{name}' would change its shape, as its parent's scale is uneven", name=obj.name)


def _shears(obj: bpy.types.Object, turn: Turn) -> bool:
    """Whether no location, rotation and scale under an object's parent are the turned object."""
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
