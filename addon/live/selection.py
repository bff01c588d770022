"""What is selected, what curves of it are relaxed together, and what these must not touch."""

import bpy

from ...core.base import Message, MobiusFlowError
from ..curves.splines import box
from ..curves.strands import KINDS, line_edges
from ..curves.surroundings import CARRIER, TUBE_OF, WITHOUT_SHAPE


def selected_curves(context: bpy.types.Context, *more: str) -> list[bpy.types.Object]:
    """The curve objects that are selected, whichever is active, and those whose motion selected copies show.

    ``more``: other custom properties of objects, which say what curve object they were made of.
    """
    selected = made_of = list(context.selected_objects)
    for name in (CARRIER, *more):
        made_of = [obj.get(name, obj) for obj in made_of if obj is not None]
    there = (obj for obj in made_of if obj is not None and (obj in selected or obj.name in context.scene.objects))
    return [obj for obj in dict.fromkeys(there) if obj.type == "CURVE"]


def shown_curves(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects whose motion is seen: those selected, and those that selected tubes' meshes were made of."""
    return selected_curves(context, TUBE_OF)


def relaxed_together(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects that are curves of any kind; a mesh with faces is none where there are others."""
    chosen = [obj for obj in context.selected_objects if obj.type in KINDS and CARRIER not in obj]
    lines = [obj for obj in chosen if obj.type != "MESH" or (obj.data.edges and not obj.data.polygons)]
    found = [*selected_curves(context), *lines]
    return found or [obj for obj in chosen if obj.type == "MESH" and line_edges(obj.data).any()]


def curves_at_hand(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects that are being edited, or the selected ones where none is."""
    return list(context.objects_in_mode) if context.mode == "EDIT_CURVE" else selected_curves(context)


def convertible(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects of this file that lines can be made of: texts, and meshes of edges alone."""
    own = (obj for obj in context.selected_objects if not (obj.library or obj.override_library))
    texts_and_meshes = (obj for obj in own if obj.type in ("FONT", "MESH"))
    return [obj for obj in texts_and_meshes if obj.type == "FONT" or (obj.data.edges and not obj.data.polygons)]


def avoided(context: bpy.types.Context, name: str | None = None) -> list[bpy.types.Object]:
    """What selected curves must not touch: visible objects with a shape of a collection, and the container they lie in.

    The collection is the scene's, or one given by name, and then there is no container. An empty name means to avoid
    nothing; raises MobiusFlowError if there is no collection of that name.
    """
    collection = context.scene.mobius_flow_surroundings.avoid if name is None else bpy.data.collections.get(name)
    if name and collection is None:
        raise MobiusFlowError(Message("There is no collection '{name}' to avoid", name=name))
    found, relaxed = list[bpy.types.Object](), relaxed_together(context)
    for obj in collection.all_objects if collection is not None else ():
        bare = obj.type in WITHOUT_SHAPE or (obj.type == "EMPTY" and obj.instance_type == "NONE")
        if not bare and obj not in relaxed and obj.visible_get():
            found.append(obj)
    outer = container(context) if name is None else None
    return found if outer is None or outer in found or not outer.visible_get() else [*found, outer]


def container(context: bpy.types.Context) -> bpy.types.Object | None:
    """The mesh that was picked as a container, if the boxes of all selected curves lie in its own."""
    outer, curves = context.scene.mobius_flow_surroundings.container, relaxed_together(context)
    if outer is None or not curves:
        return None
    (low, high), boxes = box(outer), map(box, curves)
    return outer if all((low <= least).all() and (most <= high).all() for least, most in boxes) else None
