"""What lies near the curves that are relaxed and is not kept apart from them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.types import FloatArray
from .placement import Placement
from .words import named

if TYPE_CHECKING:
    import bpy

_SOLID = {"CURVE", "MESH", "SURFACE", "META", "FONT"}
_MARGIN = 0.1  # of the diagonal of the curves' box
_MOST = 1000  # objects that are looked at on every redraw


def warning(context: "bpy.types.Context", objects: Sequence["bpy.types.Object"]) -> str | None:
    """Name what is visible near curve objects and not one of them, or return None; cheap enough for every redraw."""
    near = _near(context, objects)
    if not near:
        return None
    verb = "are" if len(near) > 1 else "is"
    return f"Only selected curves are kept apart; {named([obj.name for obj in near])} nearby {verb} not"


def _near(context: "bpy.types.Context", objects: Sequence["bpy.types.Object"]) -> list["bpy.types.Object"]:
    """Visible objects with a surface or a line whose boxes in the world overlap those of the curves, enlarged."""
    if not objects:
        return []
    boxes = np.array([_box(obj) for obj in objects])
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    margin = _MARGIN * np.linalg.norm(high - low)
    others = [obj for obj in context.visible_objects[:_MOST] if obj.type in _SOLID and obj not in objects]
    if not others:
        return []
    theirs = np.array([_box(obj) for obj in others])
    overlap = ((theirs[:, 0] <= high + margin) & (theirs[:, 1] >= low - margin)).all(axis=1)
    return [obj for obj, near in zip(others, overlap, strict=True) if near]


def _box(obj: "bpy.types.Object") -> FloatArray:
    """Lowest and highest coordinates in the world; shape (2, 3)."""
    corners = Placement.of(obj).to_world(np.array(obj.bound_box, dtype=np.float64))
    return np.stack([corners.min(axis=0), corners.max(axis=0)])
