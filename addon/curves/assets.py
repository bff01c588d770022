"""What is bundled in assets/assets.blend; it is changed in Blender 4.2, whose files all later ones load."""

from pathlib import Path
from typing import Any

import bpy

_ASSETS = Path(__file__).parents[1] / "assets" / "assets.blend"


def bundled(kind: str, name: str) -> Any:
    """A new copy of what assets/assets.blend has of a kind, such as "worlds", under a name.

    Raises OSError if the file is missing.
    """
    libraries = set(bpy.data.libraries)
    with bpy.data.libraries.load(str(_ASSETS)) as (_, wanted):
        setattr(wanted, kind, [name])
    (made,) = getattr(wanted, kind)
    made.use_fake_user = False
    bpy.data.batch_remove(set(bpy.data.libraries) - libraries)  # nothing is linked to the file
    return made


def add_nodes(obj: bpy.types.Object, name: str, *values: Any) -> None:
    """Give an object a modifier of bundled nodes, and these values of its inputs after the geometry."""
    modifier = obj.modifiers.new(name, "NODES")
    modifier.node_group = tree = bpy.data.node_groups.get(name) or bundled("node_groups", name)
    inputs = [each.identifier for each in tree.interface.items_tree if each.in_out == "INPUT"][1:]
    for identifier, value in zip(inputs, values, strict=False):
        if hasattr(modifier, "properties"):  # Blender 5.2 and later
            getattr(modifier.properties.inputs, identifier).value = value
        else:
            modifier[identifier] = value


def drop_nodes(name: str) -> None:
    """Remove bundled nodes that no object has any more."""
    tree = bpy.data.node_groups.get(name)
    if tree is not None and not tree.users:
        bpy.data.node_groups.remove(tree)
