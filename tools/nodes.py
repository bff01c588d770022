#!/usr/bin/env python3
"""Make the node groups of addon/assets/assets.blend from tools/nodes.json, in Blender 4.2 (pip install "bpy==4.2.*").

    tools/nodes.py           make all groups, and save the file
    tools/nodes.py --write   write the text anew, from what was changed in Blender

The text has, of each group, its sockets, nodes (kind, frame, settings, values of inputs) and links; what nodes have by
themselves is left out.  Looks, in the same file, are changed in Blender.
"""

import json
import re
import sys
from pathlib import Path
from typing import Any

import bpy

ASSETS = Path(__file__).parents[1] / "addon" / "assets" / "assets.blend"
TEXT = Path(__file__).with_suffix(".json")
Group = dict[str, Any]


def settings(node: Any) -> dict[str, Any]:
    """What can be set of a node, but for its name and how it is shown now."""
    kinds, shown = ("BOOLEAN", "ENUM", "FLOAT", "INT", "STRING"), ("name", "select", "height", "active_index")
    found = {p.identifier: getattr(node, p.identifier) for p in node.bl_rna.properties if p.type in kinds}
    able = {p.identifier for p in node.bl_rna.properties if not p.is_readonly and not p.identifier.startswith("bl_")}
    return {name: plain(value) for name, value in found.items() if name in able and name not in shown}


def plain(value: Any) -> Any:
    """A value that JSON can hold."""
    return [*value] if hasattr(value, "__len__") and not isinstance(value, str) else value


def values(node: Any) -> dict[str, Any]:
    """The values of inputs, by their place; objects are left out."""
    every = {str(k): getattr(each, "default_value", None) for k, each in enumerate(node.inputs)}
    return {k: plain(value) for k, value in every.items() if not isinstance(value, bpy.types.ID | None)}


def told(tree: Any) -> Group:
    """A group as text has it."""
    bare = bpy.data.node_groups.new("Bare", tree.bl_idname)
    found: Group = {"sockets": [], "nodes": {}, "links": []}
    for each in tree.interface.items_tree:
        found["sockets"].append([each.name, each.in_out, each.socket_type, plain(getattr(each, "default_value", None))])
        if isinstance(found["sockets"][-1][3], bpy.types.ID):
            found["sockets"][-1][3] = None
    for node in tree.nodes:
        usual = bare.nodes.new(node.bl_idname)
        own = {name: value for name, value in settings(node).items() if value != settings(usual)[name]}
        items = [[each.name, each.socket_type] for each in getattr(node, "repeat_items", ())]
        made = build(bare, f"{node.name} again", [node.bl_idname, None, own, None, items])
        changed = {k: value for k, value in values(node).items() if value != values(made).get(k)}
        found["nodes"][node.name] = [node.bl_idname, node.parent and node.parent.name, own, changed, items]
    places = {each: k for node in tree.nodes for side in (node.inputs, node.outputs) for k, each in enumerate(side)}
    for link in tree.links:
        ends = [link.from_node.name, places[link.from_socket], link.to_node.name, places[link.to_socket]]
        found["links"].append(ends)
    found["pairs"] = [[n.name, n.paired_output.name] for n in tree.nodes if getattr(n, "paired_output", None)]
    bpy.data.node_groups.remove(bare)
    return found


def build(tree: Any, name: str, described: list[Any]) -> Any:
    """A node, which has no values yet, as those of a loop's beginning come with its end."""
    kind, _, own, _, items = described
    node = tree.nodes.new(kind)
    node.name = name
    if items:
        node.repeat_items.clear()
    for each, socket_type in items:
        node.repeat_items.new(socket_type.removeprefix("NodeSocket").upper(), each)
    for setting, value in own.items():
        setattr(node, setting, value)
    return node


def make(name: str, group: Group) -> None:
    """Make a group, in place of the one that there is."""
    if name in bpy.data.node_groups:
        bpy.data.node_groups.remove(bpy.data.node_groups[name])
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    tree.is_modifier = tree.use_fake_user = True
    for title, way, kind, value in group["sockets"]:
        socket = tree.interface.new_socket(title, in_out=way, socket_type=kind)
        if value is not None:
            socket.default_value = value
    for each, described in group["nodes"].items():
        build(tree, each, described)
    nodes = tree.nodes
    for first, second in group["pairs"]:
        nodes[first].pair_with_output(nodes[second])
    for each, (_, frame, own, inputs, _) in group["nodes"].items():
        for k, value in inputs.items():
            nodes[each].inputs[int(k)].default_value = value
        if frame:
            nodes[each].parent = nodes[frame]
            nodes[each].location = own.get("location", (0.0, 0.0))
    for first, k, second, i in group["links"]:
        tree.links.new(nodes[first].outputs[k], nodes[second].inputs[i])


def main() -> None:
    """Make the groups, or write the text."""
    bpy.ops.wm.open_mainfile(filepath=str(ASSETS))
    if "--write" in sys.argv:
        text = json.dumps({tree.name: told(tree) for tree in bpy.data.node_groups}, indent=1, ensure_ascii=False)
        # a line for each node, and for each link
        TEXT.write_text(re.sub(r"\n {4,}|\n {3}(?=[\]}])", " ", text) + "\n", encoding="utf-8")
        return
    for name, group in json.loads(TEXT.read_text(encoding="utf-8")).items():
        make(name, group)
        if told(bpy.data.node_groups[name]) != group:
            sys.exit(f"{name}: not all is as the text has it")
    bpy.context.preferences.filepaths.save_version = 0  # no backup beside it
    bpy.ops.wm.save_as_mainfile(filepath=str(ASSETS), compress=True)


if __name__ == "__main__":
    main()
