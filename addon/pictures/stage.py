"""A scene to show a curve in: camera, lights, floor and materials."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ...core.types import FloatArray
from ..engine.placement import Frame
from .materials import material

if TYPE_CHECKING:
    import bpy

KEY_LIGHT = "Key"
_FLOOR_COLOUR = (0.88, 0.83, 0.74)
_SKY_COLOUR = (0.80, 0.88, 1.0)
_SKY_STRENGTH = 0.4
_KEY = np.array([-1.3, 0.5, 2.7])
_WIDTH = 60.0  # of the floor: the camera sees no end of it


@dataclass(frozen=True, eq=False)
class Stage:
    """Where things stand: an orthonormal frame whose third axis is up, a middle, and a size to measure by."""

    axes: FloatArray  # rows: to the right of the picture, away from it, and up
    middle: FloatArray
    size: float  # largest distance of what is shown from the middle

    @classmethod
    def around(cls, shown: Sequence[Frame | FloatArray], axes: FloatArray) -> "Stage":
        """Take in everything shown, arrays of shape (n, 3), along the given axes."""
        along = [points @ axes.T for points in shown]
        low = np.min([each.min(axis=0) for each in along], axis=0)
        middle = 0.5 * (low + np.max([each.max(axis=0) for each in along], axis=0))
        size = max(float(np.linalg.norm(each - middle, axis=1).max()) for each in along)
        return cls(axes, middle @ axes, size)


def flat_axes(points: FloatArray) -> FloatArray:
    """Principal axes of points, the thinnest as the third and rather up than down; rows, right-handed."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    for k in (0, 2):
        axes[k] *= np.sign(axes[k][np.abs(axes[k]).argmax()])
    axes[1] = np.cross(axes[2], axes[0])
    return np.asarray(axes)


def level_axes(points: FloatArray) -> FloatArray:
    """Axes of which the third is the world's up, and the first where points reach furthest sideways; rows."""
    _, _, across = np.linalg.svd((points - points.mean(axis=0))[:, :2], full_matrices=False)
    x, y = across[0] * np.sign(across[0][np.abs(across[0]).argmax()])
    return np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])


def build(collection: "bpy.types.Collection", stage: Stage) -> "bpy.types.Object":
    """Add lights and a floor to a collection; return the floor, which is at the height of the middle."""
    _add_light(collection, stage, KEY_LIGHT, _KEY, 1.5, 60.0, (1.0, 0.93, 0.84))
    _add_light(collection, stage, "Rim", (1.9, 1.9, 1.5), 0.8, 16.0, (0.80, 0.90, 1.0))
    return _add_floor(collection, stage)


def light_workbench(scene: "bpy.types.Scene", direction: npt.ArrayLike) -> None:
    """Let Workbench, which knows no lights, have its light from a direction of the world, (3,)."""
    x, y, z = np.asarray(direction) / np.linalg.norm(direction)
    scene.display.light_direction = (x, z, -y)  # its second axis is the world's up


def towards_key(stage: Stage) -> FloatArray:
    return np.asarray(_KEY @ stage.axes)


def add(collection: "bpy.types.Collection", name: str, data: "bpy.types.ID") -> "bpy.types.Object":
    import bpy

    obj = bpy.data.objects.new(name, data)
    collection.objects.link(obj)
    return obj


def place(obj: "bpy.types.Object", at: FloatArray, towards: FloatArray, up: FloatArray) -> None:
    """Put an object somewhere with its −z axis pointing at a target and its y axis up."""
    from mathutils import Matrix

    backward = (at - towards) / np.linalg.norm(at - towards)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    rotation = np.column_stack([right, np.cross(backward, right), backward])
    obj.matrix_world = Matrix(np.block([[rotation, at[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]).tolist())


def _add_light(
    collection: "bpy.types.Collection",
    stage: Stage,
    name: str,
    at: npt.ArrayLike,
    width: float,
    strength: float,
    tint: tuple[float, float, float],
) -> None:
    """Add a square light; place, width and strength are in units of the stage's size."""
    import bpy

    data = bpy.data.lights.new(name, "AREA")
    data.size = width * stage.size
    data.energy = strength * stage.size**2
    data.color = tint
    at = stage.middle + stage.size * (np.asarray(at) @ stage.axes)
    place(add(collection, name, data), at, stage.middle, stage.axes[2])


def _add_floor(collection: "bpy.types.Collection", stage: Stage) -> "bpy.types.Object":
    import bpy

    x, y = _WIDTH * stage.size * stage.axes[:2]
    data = bpy.data.meshes.new("Floor")
    data.from_pydata([p.tolist() for p in (-x - y, x - y, x + y, y - x)], [], [(0, 1, 2, 3)])
    data.materials.append(material("Paper", _FLOOR_COLOUR, {"Roughness": 0.9, "Specular IOR Level": 0.2}))
    floor = add(collection, "Floor", data)
    floor.location = stage.middle
    return floor


def add_sky(world: "bpy.types.World") -> None:
    """Light the world as an overcast sky does."""
    if world.node_tree is None:  # from Blender 5.0 on there is one from the start, and the switch is deprecated
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*_SKY_COLOUR, 1.0)
    background.inputs["Strength"].default_value = _SKY_STRENGTH
