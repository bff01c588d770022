"""A scene to show a curve in: camera, lights, floor and materials."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..core.types import FloatArray

if TYPE_CHECKING:
    import bpy

# One colour for each component, linear RGB; after the last they begin again.
_COLOURS = (
    (0.005, 0.110, 0.220),
    (0.620, 0.070, 0.030),
    (0.780, 0.400, 0.030),
    (0.060, 0.260, 0.120),
    (0.260, 0.060, 0.280),
)
_FLOOR_COLOUR = (0.88, 0.83, 0.74)
_SKY_COLOUR = (0.80, 0.88, 1.0)
_SKY_STRENGTH = 0.4
_ELEVATION = np.radians(62.0)
_LENS = 60.0  # mm, on Blender's sensor of 36 mm
_MARGIN = 1.12


@dataclass(frozen=True, eq=False)
class Stage:
    """Where things stand: an orthonormal frame whose third axis is up, a middle, and a size to measure by.

    Attributes
    ----------
    axes
        Rows are the stage's x (to the right of the picture), y (away from it) and z (up).
    middle
        Centre of what is shown.
    size
        Largest distance of what is shown from the middle.
    floor
        Height of the floor above the middle, negative.
    radius
        Largest radius of the tube.
    """

    axes: FloatArray
    middle: FloatArray
    size: float
    floor: float
    radius: float

    @classmethod
    def around(cls, shown: FloatArray, final: FloatArray, radius: float) -> "Stage":
        """Lay the final curve flat on a floor below everything shown; both of shape (n, 3)."""
        axes = flat_axes(final)
        along = shown @ axes.T
        middle = 0.5 * (along.min(axis=0) + along.max(axis=0))
        size = float(np.linalg.norm(along - middle, axis=1).max()) + radius
        return cls(axes, middle @ axes, size, float(along[:, 2].min() - middle[2]) - 1.02 * radius, radius)

    def point(self, x: float, y: float, z: float) -> FloatArray:
        """A point given in the stage's directions, in units of its size, from its middle."""
        return self.middle + self.size * (np.array([x, y, z]) @ self.axes)


def flat_axes(points: FloatArray) -> FloatArray:
    """Principal axes of points, the thinnest as the third and rather up than down; rows, right-handed."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    for k in (0, 2):
        axes[k] *= np.sign(axes[k][np.abs(axes[k]).argmax()])
    axes[1] = np.cross(axes[2], axes[0])
    return np.asarray(axes)


def build(scene: "bpy.types.Scene", stage: Stage, shown: FloatArray) -> None:
    """Add camera, lights, floor and sky to a scene; ``shown`` are the points to frame, (n, 3)."""
    _add_camera(scene, stage, shown)
    _add_light(scene, stage, "Key", (-1.6, -0.6, 2.6), 1.5, 60.0, (1.0, 0.93, 0.84))
    _add_light(scene, stage, "Rim", (1.9, 1.9, 1.5), 0.8, 16.0, (0.80, 0.90, 1.0))
    _add_floor(scene, stage)
    _add_sky(scene)


def colour(data: "bpy.types.Curve") -> None:
    """Give every spline its colour."""
    for k in range(min(len(data.splines), len(_COLOURS))):
        data.materials.append(_glazed(f"Glaze {k + 1}", _COLOURS[k]))
    for k, spline in enumerate(data.splines):
        spline.material_index = k % len(_COLOURS)


def _add(scene: "bpy.types.Scene", name: str, data: "bpy.types.ID") -> "bpy.types.Object":
    import bpy

    obj = bpy.data.objects.new(name, data)
    scene.collection.objects.link(obj)
    return obj


def _place(obj: "bpy.types.Object", at: FloatArray, towards: FloatArray, up: FloatArray) -> None:
    """Put an object somewhere with its −z axis pointing at a target and its y axis up."""
    from mathutils import Matrix

    backward = (at - towards) / np.linalg.norm(at - towards)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    rotation = np.column_stack([right, np.cross(backward, right), backward])
    obj.matrix_world = Matrix(np.block([[rotation, at[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]).tolist())


def _add_camera(scene: "bpy.types.Scene", stage: Stage, shown: FloatArray) -> None:
    import bpy

    data = bpy.data.cameras.new("Camera")
    data.lens = _LENS
    width, height = scene.render.resolution_x, scene.render.resolution_y
    slopes = 0.5 * data.sensor_width / _LENS * np.array([width, height]) / max(width, height)
    backward = np.array([0.0, -np.cos(_ELEVATION), np.sin(_ELEVATION)]) @ stage.axes
    view = np.array([stage.axes[0], np.cross(backward, stage.axes[0]), backward])
    eye = _eye(shown @ view.T, stage.radius, slopes / _MARGIN) @ view
    scene.camera = _add(scene, "Camera", data)
    _place(scene.camera, eye, eye - backward, stage.axes[2])
    distance = float((eye - stage.middle) @ backward)
    data.clip_start, data.clip_end = 1e-2 * distance, 1e2 * distance


def _eye(points: FloatArray, radius: float, slopes: FloatArray) -> FloatArray:
    """Find the nearest place from which a camera that looks along −z sees balls around all points.

    All is in the camera's directions; ``slopes`` are the tangents of half its horizontal and vertical angle of
    view. Seen from depth d, a point is inside if |x − c| ≤ s (d − z), so the outermost points give c and d.
    """
    x, reach = points[:, :2], points[:, 2:] * slopes + radius * np.sqrt(1 + slopes**2)
    high, low = (x + reach).max(axis=0), (x - reach).min(axis=0)
    return np.array([*(0.5 * (high + low)), (0.5 * (high - low) / slopes).max()])


def _add_light(
    scene: "bpy.types.Scene",
    stage: Stage,
    name: str,
    at: tuple[float, float, float],
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
    _place(_add(scene, name, data), stage.point(*at), stage.middle, stage.axes[2])


def _add_floor(scene: "bpy.types.Scene", stage: Stage) -> None:
    """Add a square so wide that the camera sees no end of it."""
    import bpy

    x, y = 60 * stage.size * stage.axes[:2]
    middle = stage.middle + stage.floor * stage.axes[2]
    data = bpy.data.meshes.new("Floor")
    data.from_pydata([(middle + p).tolist() for p in (-x - y, x - y, x + y, y - x)], [], [(0, 1, 2, 3)])
    data.materials.append(_material("Paper", _FLOOR_COLOUR, {"Roughness": 0.9, "Specular IOR Level": 0.2}))
    _add(scene, "Floor", data)


def _add_sky(scene: "bpy.types.Scene") -> None:
    import bpy

    world = scene.world or bpy.data.worlds.new("World")
    scene.world = world
    world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*_SKY_COLOUR, 1.0)
    background.inputs["Strength"].default_value = _SKY_STRENGTH


def _glazed(name: str, tint: tuple[float, float, float]) -> "bpy.types.Material":
    return _material(name, tint, {"Roughness": 0.32, "Coat Weight": 0.6, "Coat Roughness": 0.08})


def _material(name: str, tint: tuple[float, float, float], values: dict[str, float]) -> "bpy.types.Material":
    import bpy

    material = bpy.data.materials.new(name)
    material.diffuse_color = (*tint, 1.0)
    material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*tint, 1.0)
    for socket, value in values.items():
        shader.inputs[socket].default_value = value
    return material
