"""A scene to show a curve in: camera, lights, floor and materials."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
import numpy.typing as npt
from mathutils import Matrix

from ...core.types import FloatArray
from ..engine.placement import Frame
from .looks import TINT, Light, Look
from .materials import material

_WIDTH = 60.0  # of the floor: the camera sees no end of it
_ELEVATIONS = np.arange(36.0, 69.0, 4.0)  # degrees: over the horizon, and not so steep that shadows hide
_ABOVE = np.radians(89.5)  # a camera at 90 would not know what is upright
_WIDE = 1.7  # for shadows
_STEP = 10.0  # degrees, from one direction that is tried to the next
_ACROSS = 0.2  # what it is worth that a motion is wide in the picture
_TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Stage:
    """Where things stand: an orthonormal frame whose third axis is up, a middle, and a size to measure by."""

    axes: FloatArray  # rows: to the right of the picture, away from it, and up
    middle: FloatArray
    size: float  # largest distance of what is shown from the middle
    elevation: float  # of the camera over the floor, in radians
    margin: float = 1.14  # how much more than the tube the camera sees

    @classmethod
    def around(cls, shown: Sequence[Frame | FloatArray], up: FloatArray) -> "Stage":
        """Take in everything shown, arrays of shape (n, 3), to be seen well; ``up``: a direction, (3,)."""
        return cls._around(shown, *facing(shown, up))

    @classmethod
    def from_above(cls, shown: Sequence[Frame | FloatArray]) -> "Stage":
        """Take in everything shown as it lies, seen down the third axis."""
        return replace(cls._around(shown, np.eye(3), _ABOVE), margin=_WIDE)

    @classmethod
    def _around(cls, shown: Sequence[Frame | FloatArray], axes: FloatArray, elevation: float) -> "Stage":
        along = [points @ axes.T for points in shown]
        low = np.min([each.min(axis=0) for each in along], axis=0)
        middle = 0.5 * (low + np.max([each.max(axis=0) for each in along], axis=0))
        size = max(float(np.linalg.norm(each - middle, axis=1).max()) for each in along)
        return cls(axes, middle @ axes, size, elevation)


def flat_up(points: FloatArray) -> FloatArray:
    """The direction, (3,), in which points extend least, rather up than down."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return np.asarray(axes[2] * np.sign(axes[2][np.abs(axes[2]).argmax()]))


def facing(shapes: Sequence[Frame | FloatArray], up: FloatArray) -> tuple[FloatArray, float]:
    """Axes of a stage, rows, and the camera's elevation over it, from where most of a motion is seen; ``up``: (3,).

    Points with covariance C spread over an area √(dᵀ adj(C) d), seen from direction d. The ends of the motion count as
    much as all in between. Where areas are about equal, the motion lies across the picture.
    """
    weights = np.full(len(shapes), 1.0 / len(shapes))
    weights[[0, -1]] += 0.5
    sides = np.cross(up, np.eye(3)[np.abs(up).argmin()])
    level = np.array([sides, np.cross(up, sides), up]) / [[np.linalg.norm(sides)], [np.linalg.norm(sides)], [1.0]]
    turns, heights = (each.ravel() for each in np.meshgrid(np.arange(0.0, 360.0, _STEP), _ELEVATIONS))
    turns, heights = np.radians(turns), np.radians(heights)
    rights = np.column_stack([-np.sin(turns), np.cos(turns)]) @ level[:2]
    views = np.column_stack([np.cos(turns) * np.cos(heights), np.sin(turns) * np.cos(heights), np.sin(heights)]) @ level
    seen = np.zeros(len(views))
    for shape, weight in zip(shapes, weights, strict=True):
        covariance = np.cov(shape.T.astype(np.float64))
        (a, b, c), axes = np.linalg.eigh(covariance / max(np.trace(covariance), _TINY))
        areas = np.sqrt((views @ axes) ** 2 @ np.array([b * c, a * c, a * b]).clip(0.0))
        seen += weight * (areas + _ACROSS * np.sqrt((rights @ axes) ** 2 @ np.array([a, b, c]).clip(0.0)))
    best = int(seen.argmax())
    return np.array([rights[best], np.cross(up, rights[best]), up]), float(heights[best])


def build(collection: bpy.types.Collection, stage: Stage, look: Look) -> bpy.types.Object:
    """Add lights and a floor to a collection; return the floor, which is at the height of the middle."""
    for k, light in enumerate(look.lights):
        _add_light(collection, stage, "Light" if k else "Key", light)
    return _add_floor(collection, stage, look)


def light_workbench(scene: bpy.types.Scene, direction: npt.ArrayLike) -> None:
    """Let Workbench, which knows no lights, have its light from a direction of the world, (3,)."""
    x, y, z = np.asarray(direction) / np.linalg.norm(direction)
    scene.display.light_direction = (x, z, -y)  # its second axis is the world's up


def towards_key(stage: Stage, look: Look) -> FloatArray:
    return np.asarray(np.array(look.lights[0].at) @ stage.axes)


def add(collection: bpy.types.Collection, name: str, data: bpy.types.ID) -> bpy.types.Object:
    obj = bpy.data.objects.new(name, data)
    collection.objects.link(obj)
    return obj


def place(obj: bpy.types.Object, at: FloatArray, towards: FloatArray, up: FloatArray) -> None:
    """Put an object somewhere with its −z axis pointing at a target and its y axis up."""
    backward = (at - towards) / np.linalg.norm(at - towards)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    rotation = np.column_stack([right, np.cross(backward, right), backward])
    obj.matrix_world = Matrix(np.block([[rotation, at[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]).tolist())


def _add_light(collection: bpy.types.Collection, stage: Stage, name: str, light: Light) -> None:
    """Add a square light."""
    data = bpy.data.lights.new(name, "AREA")
    data.size = light.width * stage.size
    data.energy = light.power * stage.size**2
    data.color = light.tint
    at = stage.middle + stage.size * (np.array(light.at) @ stage.axes)
    place(add(collection, name, data), at, stage.middle, stage.axes[2])


def _add_floor(collection: bpy.types.Collection, stage: Stage, look: Look) -> bpy.types.Object:
    x, y = _WIDTH * stage.size * stage.axes[:2]
    data = bpy.data.meshes.new("Floor")
    data.from_pydata([p.tolist() for p in (-x - y, x - y, x + y, y - x)], [], [(0, 1, 2, 3)])
    data.materials.append(material("Floor", look.floor, {"Base Color": TINT, "Roughness": look.floor_roughness}))
    floor = add(collection, "Floor", data)
    floor.location = stage.middle
    return floor


def add_sky(world: bpy.types.World, look: Look) -> None:
    """Light the world evenly."""
    if world.node_tree is None:  # from Blender 5.0 on there is one from the start, and the switch is deprecated
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*look.sky, 1.0)
    background.inputs["Strength"].default_value = 1.0
