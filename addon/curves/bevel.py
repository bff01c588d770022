"""The tube drawn around a curve object: as thick as it can be without touching itself."""

from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve
from ..engine.tube import free_radius, thickest_radius

if TYPE_CHECKING:
    import bpy

_RESOLUTION = 6


def can_fit(data: "bpy.types.Curve") -> bool:
    """Whether a curve is drawn as a line or a plain round tube; any other shape is the user's own."""
    plain = data.bevel_mode == "ROUND" and data.taper_object is None and not data.extrude and not data.offset
    return plain and all(_radii_are_one(spline) for spline in data.splines)


def fitting_radius(curve: Curve) -> float:
    """The largest radius that is free of contact, but no more than looks like a curve."""
    return free_radius(curve, thickest_radius(curve))


def fit(data: "bpy.types.Curve", radius: float) -> None:
    """Draw a curve as a tube of this radius."""
    if not data.bevel_depth:
        data.bevel_resolution = _RESOLUTION
    data.bevel_depth = radius


def _radii_are_one(spline: "bpy.types.Spline") -> bool:
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    values = np.empty(len(points), dtype=np.float32)
    points.foreach_get("radius", values)
    return bool((values == 1).all())
