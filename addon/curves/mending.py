"""What keeps a curve object from being relaxed, mended with nothing else changed: materials, keys and users stay."""

from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve
from . import sampling
from .copying import select_instead
from .exchange import closed, write_points
from .splines import Splines

if TYPE_CHECKING:
    import bpy


def make_3d(obj: "bpy.types.Object") -> None:
    """Let points be anywhere; a 2D curve's stay where they are."""
    obj.data.dimensions = "3D"


def close(obj: "bpy.types.Object") -> None:
    """Join the ends of all splines that are open."""
    for spline in obj.data.splines:
        spline.use_cyclic_u = True


def make_single_user(obj: "bpy.types.Object") -> None:
    """Give an object curve data of its own; that of others keeps its name and its keys."""
    obj.data = obj.data.copy()


def make_local(obj: "bpy.types.Object") -> None:
    """Make an object and its curve data this file's own; materials stay linked.

    Where the object must stay as it is, because a linked collection has it, a copy is selected in its place.
    """
    local = _own(obj)
    local.data = _own(local.data)
    if not local.users_scene:
        select_instead(obj, local)


def _own(block: "bpy.types.ID") -> "bpy.types.ID":
    """A datablock as this file's own, or a copy of it where only other linked data uses it."""
    own = block.make_local(clear_liboverride=True)
    return own.copy() if own.library else own


def to_poly(obj: "bpy.types.Object") -> None:
    """Replace smooth splines by the polygons drawn for them.

    Raises
    ------
    CurveError
        If no polygon is drawn for one of them; nothing is changed then.
    """
    frames = sampling.sampled(obj)
    drawn = Curve.from_components([frame.astype(np.float64) for frame in frames], closed(obj.data))
    Splines.of(obj.data).polygons(drawn, drawn).fill(obj.data)
    write_points(obj.data, np.concatenate(frames))


def to_curve(obj: "bpy.types.Object") -> "bpy.types.Object":
    """Make a curve object of a text or of a mesh of edges, which stays; return it, selected in place of all else."""
    import bpy

    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.convert(target="CURVE", keep_original=True)
    curve = bpy.context.object
    curve.data.materials.clear()  # of a mesh Blender leaves them out
    for slot in obj.material_slots:
        curve.data.materials.append(slot.material)
    return curve
