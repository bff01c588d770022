"""Curve objects in, polygons in world space out, and back, whatever the object's transform."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..core import Curve, CurveError
from ..core.types import FloatArray
from . import sampling
from .motion import Frame
from .refinement import Places, places

if TYPE_CHECKING:
    import bpy

_FAR = 1e30  # Blender clamps infinite coordinates to the largest 32-bit number


@dataclass(frozen=True, eq=False)
class Placement:
    """The affine map from an object's coordinates to the world's, x_world = origin + linear · x_local."""

    linear: FloatArray
    origin: FloatArray

    @classmethod
    def of(cls, obj: "bpy.types.Object") -> "Placement":
        """The placement of an object whose transforms have been evaluated."""
        matrix = np.array(obj.matrix_world, dtype=np.float64)
        return cls(matrix[:3, :3], matrix[:3, 3])

    def to_world(self, points: FloatArray) -> FloatArray:
        """Points of the object in the world; shape (n, 3)."""
        return np.asarray(points @ self.linear.T + self.origin)

    def to_local(self, points: FloatArray) -> FloatArray:
        """Points of the world in the object; shape (n, 3)."""
        return np.asarray(np.linalg.solve(self.linear, (points - self.origin).T).T)


def read_curve(obj: "bpy.types.Object") -> Curve:
    """Read a curve object's splines in world space, one component each; smooth ones as the polygons drawn for them.

    Raises
    ------
    CurveError
        If a coordinate is not finite, or as good as infinite; the message names the point and its spline.
    """
    placement = Placement.of(obj)
    smooth = bool(sampling.smooth_splines(obj.data))
    frames = sampling.sampled(obj) if smooth else [spline_points(spline) for spline in obj.data.splines]
    components = [frame.astype(np.float64) for frame in frames]
    for k, component in enumerate(components, 1):
        bad = np.flatnonzero(~(np.abs(component) < _FAR).all(axis=1))
        if bad.size:
            point = f"Point {bad[0] + 1} of spline {k} of '{obj.name}'"
            raise CurveError(f"{point} is not finite, or further away than anything; repair or delete it")
    return Curve.from_components([placement.to_world(component) for component in components])


def spline_points(spline: "bpy.types.Spline") -> Frame:
    """Coordinates of a spline's points as stored; shape (n, 3)."""
    points = np.empty(4 * len(spline.points), dtype=np.float32)
    spline.points.foreach_get("co", points)
    return points.reshape(-1, 4)[:, :3]


def write_points(data: "bpy.types.Curve", frame: Frame) -> None:
    """Move the points of all splines; shape (n, 3), the object's coordinates."""
    first = 0
    for spline in data.splines:
        count = len(spline.points)
        points = np.ones((count, 4), dtype=np.float32)
        points[:, :3] = frame[first : first + count]
        spline.points.foreach_set("co", points.ravel())
        first += count
    data.update_tag()


def insert_points(data: "bpy.types.Curve", original: Curve, refined: Curve) -> None:
    """Give the splines as many points as the refined curve's components have, with values in between.

    Smooth splines become poly splines. All other properties stay; where the points are is left to `write_points`.
    """
    sizes = original.mesh.component_sizes
    for spline, size, place in zip(data.splines, sizes, places(original, refined), strict=True):
        if spline.type != "POLY":
            sampling.make_poly(spline, size)
        if len(spline.points) < len(place.edge):
            _insert_points(spline, place)


def _insert_points(spline: "bpy.types.Spline", place: Places) -> None:
    values = {name: np.empty(len(spline.points), dtype=np.float32) for name in sampling.POINT_VALUES}
    for name, array in values.items():
        spline.points.foreach_get(name, array)
    spline.points.add(len(place.edge) - len(spline.points))
    for name, array in values.items():
        spline.points.foreach_set(name, place.values(array.astype(np.float64)).astype(np.float32))


def new_curve_data(name: str, sizes: tuple[int, ...]) -> "bpy.types.Curve":
    """Make curve data of closed poly splines with so many points, all still at the origin."""
    import bpy

    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    for size in sizes:
        spline = data.splines.new("POLY")
        spline.points.add(size - 1)
        spline.use_cyclic_u = True
    return data
