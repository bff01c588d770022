"""A scene to show a curve in: a camera that follows it gently, lights, a floor below it, and materials."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from ...core.base import FloatArray
from ...core.curve.refine import interpolated
from ...core.keys.key_options import Timing
from ...core.keys.placement import Frame
from ..curves.assets import bundled
from ..curves.keyframes import ONCE, add_keys, there_and_back
from .looks import Look


@dataclass(frozen=True, eq=False)
class Ground:
    """Where things stand: an orthonormal frame whose third axis is up, a middle, and a size to measure by."""

    axes: FloatArray  # rows: to the right of the picture, away from it, and up
    middle: FloatArray
    size: float  # largest distance of what is shown from the middle
    elevation: float  # of the camera over the floor, in radians
    margin: float  # how much more than the tube the camera sees

    @classmethod
    def around(cls, shown: Sequence[Frame | FloatArray], up: FloatArray | None) -> "Ground":
        """Take in everything shown, arrays of shape (n, 3).

        It is to be seen well, if ``up`` is a direction, (3,), or else as it lies, down the third axis.
        """
        # a camera at 90 degrees would not know what is upright; the wide margin is for shadows
        axes, elevation, margin = np.eye(3), float(np.radians(89.5)), 1.7
        if up is not None:
            (axes, elevation), margin = facing(shown, up), 1.14
        along = [points @ axes.T for points in shown]
        low = np.min([each.min(axis=0) for each in along], axis=0)
        middle = 0.5 * (low + np.max([each.max(axis=0) for each in along], axis=0))
        size = max(float(np.linalg.norm(each - middle, axis=1).max()) for each in along)
        return cls(axes, middle @ axes, size, elevation, margin)


def facing(shapes: Sequence[Frame | FloatArray], up: FloatArray) -> tuple[FloatArray, float]:
    """Axes of a stage, rows, and the camera's elevation over it, from where most of a motion is seen; ``up``: (3,).

    Points with covariance C spread over an area √(dᵀ adj(C) d), seen from direction d. The ends of the motion count as
    much as all in between. Where areas are about equal, the motion lies across the picture.
    """
    weights = np.full(len(shapes), 1.0 / len(shapes))
    weights[[0, -1]] += 0.5
    sides = np.cross(up, np.eye(3)[np.abs(up).argmin()])
    level = np.array([sides, np.cross(up, sides), up]) / [[np.linalg.norm(sides)], [np.linalg.norm(sides)], [1.0]]
    tried = np.arange(0.0, 360.0, 10.0), np.arange(36.0, 69.0, 4.0)  # not so steep that shadows hide
    turns, heights = (np.radians(each.ravel()) for each in np.meshgrid(*tried))
    rights = np.column_stack([-np.sin(turns), np.cos(turns)]) @ level[:2]
    views = np.column_stack([np.cos(turns) * np.cos(heights), np.sin(turns) * np.cos(heights), np.sin(heights)]) @ level
    seen = np.zeros(len(views))
    for shape, weight in zip(shapes, weights, strict=True):
        covariance = np.cov(shape.T.astype(np.float64))
        (a, b, c), axes = np.linalg.eigh(covariance / max(np.trace(covariance), 1e-300))
        areas = np.sqrt((views @ axes) ** 2 @ np.array([b * c, a * c, a * b]).clip(0.0))
        seen += weight * (areas + 0.2 * np.sqrt((rights @ axes) ** 2 @ np.array([a, b, c]).clip(0.0)))
    best = int((seen - np.linspace(0.0, 1e-3, len(seen))).argmax())  # of those that symmetry makes equal the first
    return np.array([rights[best], np.cross(up, rights[best]), up]), float(heights[best])


def build(collection: bpy.types.Collection, stage: Ground, look: Look) -> bpy.types.Object:
    """Add lights and a floor to a collection; return the floor, which is at the height of the middle."""
    lights = bundled("collections", look.label)
    frame = np.eye(4)
    for light in list(lights.objects):  # the key light first
        data, turned = light.data, np.array(light.matrix_basis)
        turned[:3, 3] *= stage.size
        frame[:3, :3], frame[:3, 3] = stage.axes.T, stage.middle
        light.matrix_world = Matrix((frame @ turned).tolist())
        data.size, data.energy = data.size * stage.size, data.energy * stage.size**2
        light.name = data.name = data.name.partition(".")[0]
        collection.objects.link(light)
    bpy.data.collections.remove(lights)
    x, y = 60.0 * stage.size * stage.axes[:2]  # the camera sees no end of it
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([p.tolist() for p in (-x - y, x - y, x + y, y - x)], [], [(0, 1, 2, 3)])
    mesh.materials.append(bundled("materials", f"{look.label} Floor"))
    mesh.materials[0].name = "Floor"
    floor = add(collection, "Floor", mesh)
    floor.location = stage.middle
    return floor


def light_workbench(scene: bpy.types.Scene, collection: bpy.types.Collection) -> None:
    """Light Workbench, which ignores lights, from where the first light of a stage's collection, the key light, is."""
    if key := next((each for each in collection.objects if each.type == "LIGHT"), None):
        x, y, z = key.matrix_world.col[2].to_3d().normalized()
        scene.display.light_direction = (x, z, -y)  # its second axis is the world's up


def add(collection: bpy.types.Collection, name: str, data: bpy.types.ID) -> bpy.types.Object:
    obj = bpy.data.objects.new(name, data)
    collection.objects.link(obj)
    return obj


def follow(
    collection: bpy.types.Collection,
    size: tuple[float, float],
    stage: Ground,
    floor: bpy.types.Object,
    seen: Sequence[FloatArray],
    points: "Sequence[Frame | FloatArray]",
    radii: FloatArray,
    frames: FloatArray,
    timing: Timing = ONCE,
) -> bpy.types.Object:
    """Add a camera that sees what is to be seen of a tube in every frame, and keep the floor just below the whole tube.

    It swings around the stage, looks at an empty and is focused there. ``size`` is that of its pictures, in any unit;
    the floor is at the height of the stage's middle; points are the vertices, (n, 3), of every key, and ``seen`` those
    as they are `framed`; ``timing`` tells whether keys are passed again on the way back.
    """
    data, calm = bpy.data.cameras.new("Camera"), 25  # frames over which its way is smoothed
    data.lens, data.sensor_width = 60.0, 36.0  # mm
    camera, focus = add(collection, "Camera", data), add(collection, "Focus", None)
    every = np.arange(np.floor(frames[0]), np.ceil(frames[-1]) + 1)
    slopes = 0.5 * data.sensor_width / data.lens * np.array(size) / max(size)  # tangents of half the angles of view
    stacked, places = np.stack(seen), np.interp(every, frames, np.arange(len(frames)))
    shapes = [(interpolated(stacked, at[None])[0] - stage.middle) @ stage.axes.T for at in places]
    views = []  # right, up and backward, in the stage's axes, rows; once to either side in a film
    for turn in np.radians(24.0) * np.sin(np.linspace(0.0, 2.0 * np.pi, len(every))):
        right, level = np.array([np.cos(turn), np.sin(turn), 0.0]), np.array([np.sin(turn), -np.cos(turn), 0.0])
        backward = np.cos(stage.elevation) * level + np.array([0.0, 0.0, np.sin(stage.elevation)])
        views.append(np.array([right, np.cross(backward, right), backward]))
    # seen from distance d, a point is inside the picture if |x − c| ≤ s (d − z): the outermost points give the best
    # centre c, and then the distance that a calmly moving c needs; all in the stage's axes
    slopes, thick = slopes / stage.margin, np.interp(every, frames, radii)
    reaches = thick[:, None] * np.sqrt(1 + slopes**2)
    turned = [shape @ view.T for shape, view in zip(shapes, views, strict=True)]
    high = [(p[:, :2] + p[:, 2:] * slopes + r).max(axis=0) for p, r in zip(turned, reaches, strict=True)]
    low = [(p[:, :2] - p[:, 2:] * slopes - r).min(axis=0) for p, r in zip(turned, reaches, strict=True)]
    centres = [0.5 * (a + b) @ view[:2] for a, b, view in zip(high, low, views, strict=True)]
    targets = uniform_filter1d(np.array(centres), calm, axis=0, mode="nearest")
    looked = np.array([view @ target for view, target in zip(views, targets, strict=True)])
    needed = np.maximum(high - looked[:, :2], looked[:, :2] - low) / slopes - looked[:, 2:]

    def bounded(values: FloatArray) -> FloatArray:
        """A smooth upper bound of values in consecutive frames: the mean of the largest nearby."""
        return np.asarray(uniform_filter1d(maximum_filter1d(values, calm, mode="nearest"), calm, mode="nearest"))

    distances = bounded(needed.max(axis=1))
    heights = np.array([((p - stage.middle) @ stage.axes[2]).min() for p in points]) - 1.02 * radii
    lows = -bounded(-np.interp(every, frames, heights))
    for obj, places in (
        (focus, stage.middle + targets @ stage.axes),
        (camera, stage.middle + (targets + distances[:, None] * np.array(views)[:, 2]) @ stage.axes),
        (floor, stage.middle + lows[:, None] * stage.axes[2]),
    ):
        obj.location = places[0]
        for axis in range(3) if np.ptp(places, axis=0).any() else ():
            keyed = there_and_back(every, places[:, axis], timing)
            add_keys(obj, f"{obj.name} Motion", "location", axis, *keyed)
    focus.rotation_euler, focus.empty_display_size = Matrix(stage.axes.T.tolist()).to_euler(), 0.1 * stage.size
    look = camera.constraints.new("TRACK_TO")
    look.target, look.track_axis, look.up_axis, look.use_target_z = focus, "TRACK_NEGATIVE_Z", "UP_Y", True
    data.clip_start, data.clip_end = 1e-2 * distances.min(), 1e2 * distances.max()
    data.dof.use_dof, data.dof.focus_object = True, focus
    # what is a size of the stage off the focus is softened by 0.03 of one; a lens is measured in millimetres
    data.dof.aperture_fstop = 1e-3 * data.lens / (0.03 * stage.size)
    return camera
