"""What shapes are made with: the objects, textures and node trees that modifiers and other data refer to."""

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Any

from .deforming import nodes_of

if TYPE_CHECKING:
    import bpy


def ingredients(block: "bpy.types.bpy_struct") -> Iterator["bpy.types.ID"]:
    """Yield what a modifier or other data refers to: objects, also those of collections, textures and node trees."""
    import bpy

    for each in chain(_pointers(block), _inputs(block)):
        if isinstance(each, bpy.types.Collection):
            yield from each.all_objects
        elif isinstance(each, bpy.types.Object | bpy.types.Texture):
            yield each
        elif isinstance(each, bpy.types.GeometryNodeTree):
            yield each
            for node in nodes_of(each, set()):
                yield from ingredients(node)


def metaballs(obj: "bpy.types.Object") -> Iterator["bpy.types.Object"]:
    """Yield the metaballs that are one surface with a metaball: those called the same up to the first dot."""
    import bpy

    if obj.type == "META":
        yield from (each for each in bpy.data.objects if each.type == "META" and _stem(each) == _stem(obj))


def _stem(obj: "bpy.types.Object") -> str:
    return str(obj.name).partition(".")[0]


def _pointers(block: "bpy.types.bpy_struct") -> "Iterator[Any]":
    for each in block.bl_rna.properties:
        if each.type == "POINTER":
            yield getattr(block, each.identifier)


def _inputs(block: "bpy.types.bpy_struct") -> "Iterator[Any]":
    """Values of sockets: of a node, and of a modifier, which before Blender 5.2 has them as custom properties."""
    import bpy

    if isinstance(block, bpy.types.Node):
        yield from (getattr(socket, "default_value", None) for socket in block.inputs)
    elif isinstance(block, bpy.types.NodesModifier) and hasattr(block, "properties"):
        yield from (getattr(socket, "value", None) for socket in _pointers(block.properties.inputs))
    elif isinstance(block, bpy.types.NodesModifier):
        yield from (value for _, value in block.items())
