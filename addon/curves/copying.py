"""Copies of curve objects as they are shown now, without all that moves them or their points."""

from typing import TYPE_CHECKING

from . import bake
from .deforming import deforms
from .splines import Splines

if TYPE_CHECKING:
    import bpy
    import mathutils


def still_copy(obj: "bpy.types.Object") -> "bpy.types.Object":
    """Copy a curve object as it is shown now, and select the copy in its place; the original stays as it is.

    The copy has neither keys, drivers, constraints nor a parent, and none of the modifiers that may move points. The
    points are where keys and modifiers have put them; what geometry nodes and a parent do to them is left out.
    """
    import bpy

    world = obj.matrix_world.copy()
    copy = obj.copy()
    select_instead(obj, copy)
    shown = _shown(copy)
    copy.data = obj.data.copy()
    _strip(copy)
    shown.fill(copy.data)
    bpy.context.view_layer.update()
    if copy.matrix_world != world:  # what was taken away held it there
        _put(copy, world)
    return copy


def select_instead(obj: "bpy.types.Object", copy: "bpy.types.Object") -> None:
    """Put a copy into the collections of the original, selected, and active if the original was."""
    import bpy

    view_layer = bpy.context.view_layer
    was_active = view_layer.objects.active == obj
    own = [each for each in obj.users_collection if each.library is None and each.override_library is None]
    for collection in own or [bpy.context.scene.collection]:
        collection.objects.link(copy)
    obj.select_set(False)
    copy.select_set(True)
    if was_active:
        view_layer.objects.active = copy


def _put(obj: "bpy.types.Object", world: "mathutils.Matrix") -> None:
    """Put an object somewhere; shear, which no object has by itself, goes into its points."""
    import bpy

    obj.matrix_world = world
    bpy.context.view_layer.update()
    obj.data.transform(obj.matrix_world.inverted_safe() @ world)


def _shown(obj: "bpy.types.Object") -> Splines:
    """The splines as keys and modifiers leave them; the modifiers are told to work on the splines themselves."""
    import bpy

    for modifier in filter(deforms, obj.modifiers):
        modifier.use_apply_on_spline = True
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(depsgraph)
    try:
        return Splines.of(evaluated.to_curve(depsgraph, apply_modifiers=True))
    finally:
        evaluated.to_curve_clear()


def _strip(obj: "bpy.types.Object") -> None:
    """Take away all that moves an object with curve data of its own, or the points of it."""
    for modifier in list(filter(deforms, obj.modifiers)):
        obj.modifiers.remove(modifier)
    bake.forget(obj)
    obj.data.animation_data_clear()
    obj.animation_data_clear()
    obj.constraints.clear()
    obj.parent = None
