"""The tube drawn around a curve object: as thick as it can be without touching itself.

A bevel is the artist's own until somebody asks to have it fitted. Depths that were fitted are noted on the curve data.
A curve that has one of them, wherever undo or *Clear* have brought it back from, is fitted again when it is relaxed;
one that has been given another depth since is the artist's.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve, Obstacle
from ..engine.tube import free_radius, radius_beside, thickest_radius

if TYPE_CHECKING:
    import bpy

_FITTED = "mobius_flow_tube"  # custom property of curve data: depths that were fitted
_RESOLUTION = 6


def can_fit(data: "bpy.types.Curve") -> bool:
    """Whether a curve is drawn as a line or a plain round tube; any other shape is the user's own."""
    plain = data.bevel_mode == "ROUND" and data.taper_object is None and not data.extrude and not data.offset
    return plain and all(_radii_are_one(spline) for spline in data.splines)


def is_fitted(data: "bpy.types.Curve") -> bool:
    """Whether a curve is drawn as the tube that was fitted to it."""
    return data.bevel_depth in list(data.get(_FITTED, ()))


def fitting_radius(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> float:
    """The largest radius that is free of contact, but no more than looks like a curve."""
    return radius_beside(curve, free_radius(curve, thickest_radius(curve)), obstacles)


def fit(data: "bpy.types.Curve", radius: float) -> None:
    """Draw a curve as the tube that fits, and note that it is one."""
    draw(data, radius)
    data[_FITTED] = sorted({*data.get(_FITTED, ()), data.bevel_depth})


def draw(data: "bpy.types.Curve", radius: float) -> None:
    """Draw a curve as a tube of this radius."""
    if not data.bevel_depth:
        data.bevel_resolution, data.use_fill_caps = _RESOLUTION, True  # which closed splines have no use for
    data.bevel_depth = radius


def _radii_are_one(spline: "bpy.types.Spline") -> bool:
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    values = np.empty(len(points), dtype=np.float32)
    points.foreach_get("radius", values)
    return bool((values == 1).all())
