"""Smooth splines in curve objects of their own."""

from collections.abc import Sequence
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve
from ...core.types import FloatArray
from ..engine.cubic_spline import bezier_points
from ..engine.placement import Frame, Placement
from ..engine.smooth_fit import SmoothFit, fitted
from . import bevel
from .outputs import object_like

if TYPE_CHECKING:
    import bpy

_LOOKS = ("bevel_mode", "bevel_depth", "bevel_resolution", "extrude", "offset", "taper_object", "bevel_object")
_RESOLUTION = 12  # points drawn for each segment


def smooth_objects(
    objects: Sequence["bpy.types.Object"], link: Curve, points: int | None, kind: str
) -> tuple[list["bpy.types.Object"], SmoothFit]:
    """Make curve objects of smooth splines where others are, with their bevels and materials.

    Parameters
    ----------
    objects
        The other objects.
    link
        Their splines as polygons in the world.
    points
        Number of points of each spline, see `fitted`.
    kind
        'BEZIER' or 'NURBS': the same curve, with other points to edit.

    Returns
    -------
    The objects, and the splines as they are stored in them, in the world.
    """
    wanted = iter(fitted(link, points).points)
    made, shown = [], []
    for obj in objects:
        place = Placement.from_matrix(obj.matrix_world)
        stored = [place.to_local(each).astype(np.float32) for each in islice(wanted, len(obj.data.splines))]
        made.append(_object(obj, stored, kind))
        shown += [place.to_world(each.astype(np.float64)) for each in stored]
    return made, SmoothFit(link, tuple(shown))


def _object(obj: "bpy.types.Object", control: Sequence[Frame], kind: str) -> "bpy.types.Object":
    import bpy

    data = bpy.data.curves.new(f"{obj.name} Smooth", "CURVE")
    data.dimensions, data.resolution_u = "3D", _RESOLUTION
    for name in _LOOKS:
        setattr(data, name, getattr(obj.data, name))
    if bevel.is_fitted(obj.data):
        bevel.fit(data, data.bevel_depth)
    for material in obj.data.materials:
        data.materials.append(material)
    for points, old in zip(control, obj.data.splines, strict=True):
        spline = data.splines.new(kind)
        spline.use_cyclic_u = old.use_cyclic_u
        (_fill_bezier if kind == "BEZIER" else _fill_nurbs)(spline, points)
        spline.material_index = old.material_index
    return object_like(obj, data)


def _fill_bezier(spline: "bpy.types.Spline", control: Frame) -> None:
    closed = bool(spline.use_cyclic_u)
    left, place, right = _with_handles(bezier_points(control.astype(np.float64), closed), closed)
    points = spline.bezier_points
    points.add(len(place) - 1)
    for point in points:  # aligned handles stay in line when somebody moves them
        point.handle_left_type = point.handle_right_type = "ALIGNED"
    for name, array in (("co", place), ("handle_right", right), ("handle_left", left)):
        points.foreach_set(name, array.astype(np.float32).ravel())


def _with_handles(bezier: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Left handles, points and right handles; at the ends of an open spline the outer handles mirror the inner ones."""
    if closed:
        return np.roll(bezier[:, 2], 1, axis=0), bezier[:, 0], bezier[:, 1]
    place = np.concatenate([bezier[:, 0], bezier[-1:, 3]])
    right, left = bezier[:, 1], bezier[:, 2]
    before, after = 2 * place[:1] - right[:1], 2 * place[-1:] - left[-1:]
    return np.concatenate([before, left]), place, np.concatenate([right, after])


def _fill_nurbs(spline: "bpy.types.Spline", control: Frame) -> None:
    spline.points.add(len(control) - 1)
    spline.points.foreach_set("co", np.pad(control, ((0, 0), (0, 1)), constant_values=1.0).ravel())
    spline.order_u, spline.use_endpoint_u = 4, not spline.use_cyclic_u
