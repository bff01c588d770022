"""Copies of shader nodes in another tree, for which Blender has no function."""

from collections.abc import Iterable
from contextlib import suppress
from typing import Any

import bpy

_LOOKS = ("name", "label", "width", "mute", "hide")


def copied(source: bpy.types.NodeTree, tree: bpy.types.NodeTree) -> dict[bpy.types.Node, bpy.types.Node]:
    """Copy all nodes of a tree, with their links, into another one; the copy of each.

    Kinds of nodes that no running extension knows are left out: they do nothing.
    """
    known = [node for node in source.nodes if hasattr(bpy.types, node.bl_idname)]
    copies = {node: tree.nodes.new(node.bl_idname) for node in known}
    common = _settings(bpy.types.Node)
    for node, copy in copies.items():
        _imitate(node, copy, [*_LOOKS, *(each for each in _settings(node) if each not in common)])
        for side in ("inputs", "outputs"):
            for one, other in zip(getattr(node, side), getattr(copy, side), strict=False):
                _imitate(one, other, ["default_value"])
    for node, copy in copies.items():
        copy.parent = copies.get(node.parent)
        copy.location = node.location  # which is relative to the parent's
    for link in source.links:
        if link.from_node in copies and link.to_node in copies:
            start = list(link.from_node.outputs).index(link.from_socket)
            end = list(link.to_node.inputs).index(link.to_socket)
            tree.links.new(copies[link.from_node].outputs[start], copies[link.to_node].inputs[end])
    return copies


def _settings(owner: Any) -> list[str]:
    return [prop.identifier for prop in owner.bl_rna.properties]


def _imitate(one: Any, other: Any, names: Iterable[str]) -> None:
    """Give something some of the settings of another thing of its kind; ramps and curves are within such things."""
    for name in names:
        value, prop = getattr(one, name, None), one.bl_rna.properties.get(name)
        if prop is None or name == "rna_type":
            continue
        if not prop.is_readonly:
            with suppress(TypeError, ValueError):  # what another setting rules out
                setattr(other, name, value)
        elif name in ("elements", "curves", "points"):
            _imitate_all(value, getattr(other, name))
        elif prop.type == "POINTER" and value is not None:
            _imitate(value, getattr(other, name), _settings(value))
    if hasattr(other, "initialize"):  # curves are tables, made when they change
        other.update()


def _imitate_all(parts: Any, others: Any) -> None:
    """The same for the stops of a color ramp, and for curves and their points."""
    while len(others) > len(parts):
        others.remove(others[-1])
    for k, part in enumerate(parts):
        if k == len(others):
            others.new(*(part.location if hasattr(part, "location") else (part.position,)))
        _imitate(part, others[k], _settings(part))
