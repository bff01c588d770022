"""What lies near the curves that are relaxed and is not kept apart from them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.words import named
from .surfaces import SOLID

if TYPE_CHECKING:
    import bpy

STAGE = "mobius_flow_stage"  # custom property of what only surrounds curves, to be seen with them
_MARGIN = 0.1  # of the diagonal of the curves' box


def warning(
    context: "bpy.types.Context", objects: Sequence["bpy.types.Object"], avoided: Sequence["bpy.types.Object"] = ()
) -> Message | None:
    """Name what is visible near curve objects, and neither one of them nor avoided by them, or return None."""
    if not (found := near(context, objects, avoided)):
        return None
    names = named([obj.name for obj in found])
    if len(found) > 1:
        return Message("{names} nearby are neither selected nor avoided, and may be crossed", names=names)
    return Message("{names} nearby is neither selected nor avoided, and may be crossed", names=names)


def near(
    context: "bpy.types.Context", objects: Sequence["bpy.types.Object"], avoided: Sequence["bpy.types.Object"] = ()
) -> list["bpy.types.Object"]:
    """Other visible objects with a surface or a line whose boxes in the world overlap those of the curves, enlarged.

    Cheap enough for every redraw.
    """
    everything = context.view_layer.objects
    together = set(objects)
    mine = np.array([obj in together for obj in everything], dtype=bool)
    if not mine.any():
        return []
    low, high = _boxes(everything)
    lowest, highest = low[mine].min(axis=0), high[mine].max(axis=0)
    margin = _MARGIN * np.linalg.norm(highest - lowest)
    overlap = (low <= highest + margin).all(axis=1) & (high >= lowest - margin).all(axis=1)
    candidates = (everything[int(k)] for k in np.flatnonzero(overlap & ~mine))
    others = (obj for obj in candidates if obj.type in SOLID and obj not in avoided)
    return [obj for obj in others if STAGE not in obj and obj.visible_get()]


def _boxes(objects: "bpy.types.bpy_prop_collection") -> tuple[FloatArray, FloatArray]:
    """Lowest and highest coordinates of objects in the world, each of shape (n, 3)."""
    matrices = np.empty(16 * len(objects), dtype=np.float32)
    corners = np.empty(24 * len(objects), dtype=np.float32)
    objects.foreach_get("matrix_world", matrices)  # column by column
    objects.foreach_get("bound_box", corners)
    matrices = matrices.reshape(-1, 4, 4)
    world = corners.reshape(-1, 8, 3) @ matrices[:, :3, :3] + matrices[:, 3:, :3]
    return world.min(axis=1), world.max(axis=1)
