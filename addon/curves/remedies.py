"""Remedies for what keeps a curve object from being relaxed; all else stays: materials, keys and users."""

import bpy
import numpy as np

from ...core import Curve
from . import bake
from .exchange import closed, write_points
from .moving import deforms
from .splines import Splines, sampled


def close(obj: bpy.types.Object) -> None:
    for spline in obj.data.splines:
        spline.use_cyclic_u = True


def make_local(obj: bpy.types.Object) -> None:
    """Make an object and its curve data this file's own; materials stay linked.

    If the object must stay as it is, because it is in a linked collection, a copy is selected in its place.
    """
    local = _own(obj)
    local.data = _own(local.data)
    if not local.users_scene:
        _select_instead(obj, local)


def _own(block: bpy.types.ID) -> bpy.types.ID:
    """A datablock as this file's own, or a copy of it where only other linked data uses it."""
    own = block.make_local(clear_liboverride=True)
    return own.copy() if own.library else own


def to_poly(obj: bpy.types.Object) -> None:
    """Replace smooth splines by the polygons drawn for them.

    Raises CurveError if no polygon is drawn for one of them; nothing is changed then.
    """
    frames = sampled(obj)
    drawn = Curve.from_components([frame.astype(np.float64) for frame in frames], closed(obj.data))
    Splines.of(obj.data).polygons(drawn, drawn).fill(obj.data)
    write_points(obj.data, np.concatenate(frames))


def to_curve(obj: bpy.types.Object) -> bpy.types.Object:
    """Make a curve object from a text or a mesh of edges, which stays; return it, the only object selected."""
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.convert(target="CURVE", keep_original=True)
    curve = bpy.context.object
    curve.data.materials.clear()  # for meshes Blender leaves them out
    for slot in obj.material_slots:
        curve.data.materials.append(slot.material)
    return curve


def still_copy(obj: bpy.types.Object) -> bpy.types.Object:
    """Copy a curve object as it is shown now, and select the copy in its place; the original stays as it is.

    The copy has neither keys, drivers, constraints nor a parent, and none of the modifiers that may move points. The
    points are where keys and modifiers have put them; what geometry nodes and a parent do to them is left out.
    """
    world = obj.matrix_world.copy()
    copy = obj.copy()
    _select_instead(obj, copy)
    shown = _shown(copy)
    copy.data = obj.data.copy()
    _strip(copy)
    shown.fill(copy.data)
    bpy.context.view_layer.update()
    if copy.matrix_world != world:  # something that was removed held it there
        copy.matrix_world = world
        bpy.context.view_layer.update()
        copy.data.transform(copy.matrix_world.inverted_safe() @ world)  # shear, which no object has by itself
    return copy


def _select_instead(obj: bpy.types.Object, copy: bpy.types.Object) -> None:
    """Put a copy into the collections of the original, selected, and active if the original was."""
    view_layer = bpy.context.view_layer
    was_active = view_layer.objects.active == obj
    own = [each for each in obj.users_collection if each.library is None and each.override_library is None]
    for collection in own or [bpy.context.scene.collection]:
        collection.objects.link(copy)
    obj.select_set(False)
    copy.select_set(True)
    if was_active:
        view_layer.objects.active = copy


def _shown(obj: bpy.types.Object) -> Splines:
    """The splines as keys and modifiers leave them; the modifiers are set to work on the splines themselves."""
    for modifier in filter(deforms, obj.modifiers):
        modifier.use_apply_on_spline = True
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(depsgraph)
    try:
        return Splines.of(evaluated.to_curve(depsgraph, apply_modifiers=True))
    finally:
        evaluated.to_curve_clear()


def _strip(obj: bpy.types.Object) -> None:
    """Remove all that moves an object with curve data of its own, or moves its points."""
    for modifier in list(filter(deforms, obj.modifiers)):
        obj.modifiers.remove(modifier)
    bake.forget(obj)
    obj.data.animation_data_clear()
    obj.animation_data_clear()
    obj.constraints.clear()
    obj.parent = None
