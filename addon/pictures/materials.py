"""The materials of looks, built from their descriptions, and one that shows the colours of a mesh's vertices."""

from collections.abc import Mapping
from typing import Any

import bpy
import numpy as np

from ...core.types import FloatArray
from ..engine.colours import flatly_lit
from .looks import ALONG, DEFAULT, LOOKS, SHADER, STRAND, TINT, TURNS, YARN, Nodes, Tint

_NONE: Mapping[str, Any] = {}
_PIXELS = 1024  # of what changes along a component
_PITCH = 1.55  # of a rope's strands, in its radii


def colour_components(
    data: bpy.types.Curve, first: int = 0, look: str = DEFAULT, along: FloatArray | None = None
) -> None:
    """Give every spline the colour of its component, from number ``first`` on, in slots after the existing ones.

    ``along``: the share of the length at each vertex of a component that is alone, (n,), where it is not even. With it,
    colours change along the component if the look has any for that: they set its strands apart.
    """
    made_of, slots = LOOKS[look], dict[int, int]()
    hues = len(made_of.palette)
    for component, spline in enumerate(data.splines, first):
        hue = hues if along is not None and made_of.gradient else component % hues
        if hue not in slots:
            wanted = _glaze(data, look, hue, along)
            if wanted.name not in data.materials:
                data.materials.append(wanted)
            slots[hue] = int(data.materials.find(wanted.name))
        spline.material_index = slots[hue]


def _glaze(data: bpy.types.Curve, look: str, hue: int, along: FloatArray | None) -> bpy.types.Material:
    """The material of a component; one that already exists is used, as other objects may have it.

    After the palette's hues comes the gradient.
    """
    made_of = LOOKS[look]
    name = f"{made_of.label} {hue + 1}"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    share = np.linspace(0.0, 1.0, 2) if along is None else along
    places = np.interp(np.arange(_PIXELS) / _PIXELS, np.linspace(0.0, 1.0, len(share)), share)
    length = sum(spline.calc_length() for spline in data.splines) / len(data.splines)
    radius = data.bevel_depth or length / 60.0
    turns = 0.2 * np.pi * max(round(length / (_PITCH * radius)), 3)
    nodes, words = dict(made_of.nodes), {ALONG: "place.Vector", TURNS: (turns, 0.6 * np.pi, 0.0)}
    words |= {STRAND: 0.5 * radius, YARN: 0.08 * radius}
    if hue == len(made_of.palette):
        stops = np.array((*made_of.gradient, made_of.gradient[0]))
        colours = [np.interp(places * (len(stops) - 1), np.arange(len(stops)), channel) for channel in stops.T]
        nodes |= {"gradient": ("ShaderNodeTexImage", {}, {"image": _table(f"{name} Colors", np.array(colours).T)})}
        words[TINT] = "gradient.Color"
    if made_of.uses_place:
        table = {"image": _table(f"{name} Places", np.column_stack(3 * [places])), "extension": "EXTEND"}
        nodes |= {
            "share": ("ShaderNodeTexImage", {}, table),
            "uv": ("ShaderNodeUVMap", {}, {}),
            "sides": ("ShaderNodeSeparateXYZ", {"Vector": "uv.UV"}, {}),
            "place": ("ShaderNodeCombineXYZ", {"X": "share.Color", "Y": "sides.Y"}, {}),
        }
    return material(name, made_of.palette[hue % len(made_of.palette)], made_of.shader, nodes, words)


def vertex_colours(attribute: str) -> bpy.types.Material:
    """A material whose colour is an attribute of the mesh; the existing one of that name if there is one."""
    name = f"Glaze {attribute}"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    colours: Nodes = {"colors": ("ShaderNodeVertexColor", {}, {"layer_name": attribute})}
    return material(name, (0.2, 0.2, 0.2), LOOKS[DEFAULT].shader, colours, {TINT: "colors.Color"})


def material(
    name: str,
    tint: Tint,
    shader: Mapping[str, Any],
    nodes: Nodes = _NONE,
    words: Mapping[str, Any] = _NONE,
) -> bpy.types.Material:
    """A new material: inputs of its shader, and nodes that feed them; ``words`` is what words among the inputs mean."""
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*flatly_lit(np.array(tint)), 1.0)
    made.roughness = shader["Roughness"]
    if made.node_tree is None:  # from Blender 5.0 on there is one from the start, and the switch is deprecated
        made.use_nodes = True
    tree = made.node_tree
    found = {SHADER: next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")}
    for k, (title, (kind, _, settings)) in enumerate(nodes.items(), 1):
        found[title] = tree.nodes.new(kind)
        found[title].name, found[title].location = title, (-220 * k, 300)
        for setting, value in settings.items():
            setattr(found[title], setting, value)
    meant = {TINT: (*tint, 1.0)} | dict(words)
    for title, inputs in {SHADER: shader, **{title: inputs for title, (_, inputs, _) in nodes.items()}}.items():
        for socket, value in inputs.items():
            known = isinstance(value, str) and value in meant
            _feed(tree, found[title].inputs[socket], meant[value] if known else value)
    if TINT in words:
        tree.nodes.active = found[words[TINT].split(".")[0]]  # Workbench shows it
    return made


def _feed(tree: bpy.types.NodeTree, socket: Any, value: Any) -> None:
    if isinstance(value, str):
        title, output = value.split(".")
        tree.links.new(tree.nodes[title].outputs[output], socket)
    else:
        socket.default_value = value[: len(socket.default_value)] if isinstance(value, tuple) else value


def _table(name: str, rows: FloatArray) -> bpy.types.Image:
    """An image one pixel high, which is read along a component by its texture coordinates; rows of RGB."""
    pixels = np.ones((len(rows), 4), dtype=np.float32)
    pixels[:, :3] = rows
    image = bpy.data.images.new(name, len(rows), 1, float_buffer=True)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image
