"""A scene to show a curve in: a camera that follows it gently, lights, a floor below it, and materials."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import mathutils
import numpy as np
import numpy.typing as npt
from mathutils import Matrix
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ...core.types import FloatArray
from ..curves.keyframes import FCurves
from ..engine.interpolation import interpolated
from ..engine.placement import Frame
from .looks import TINT, Look
from .materials import material

_WIDTH = 60.0  # of the floor: the camera sees no end of it
_ELEVATIONS = np.arange(36.0, 69.0, 4.0)  # degrees: over the horizon, and not so steep that shadows hide
_ABOVE = np.radians(89.5)  # a camera at 90 would not know what is upright
_WIDE = 1.7  # for shadows
_STEP = 10.0  # degrees, from one direction that is tried to the next
_ACROSS = 0.2  # the weight of how wide a motion is in the picture
_TINY = 1e-300
_LENS = 60.0  # mm
_SENSOR = 36.0  # mm
_CALM = 25  # frames over which the camera's way is smoothed
_LIFT = 1.02  # of the tube's radius: how far the lowest point stays above the floor
_ORBIT = np.radians(24.0)  # to either side, once in a film
_APERTURE = 0.03  # width of the lens in sizes of the stage: what is a size off the focus is softened by so much


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
        # add a square light
        name = "Light" if k else "Key"
        data = bpy.data.lights.new(name, "AREA")
        data.size = light.width * stage.size
        data.energy = light.power * stage.size**2
        data.color = light.tint
        at = stage.middle + stage.size * (np.array(light.at) @ stage.axes)
        place(add(collection, name, data), at, stage.middle, stage.axes[2])
    return _add_floor(collection, stage, look)


def light_workbench(scene: bpy.types.Scene, direction: npt.ArrayLike) -> None:
    """Light Workbench, which ignores lights, from a direction of the world, (3,)."""
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
