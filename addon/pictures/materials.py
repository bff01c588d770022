"""The materials of looks, one that shows the colours of a mesh's vertices, and nodes that compute numbers of a curve.

They are made of what is in assets/assets.blend; it is changed in Blender 4.2, whose files all later ones load.  In a
tube's material the nodes that are set here have names: "tint", the colour of a component, or "gradient" in its place;
"share", "lay", "fine" and "bump", what depends on a curve's length and thickness.
"""

import bpy
import numpy as np

from ...core.base import FloatArray
from ...core.keys.colours import flatly_lit
from ..curves.assets import bundled
from .looks import DEFAULT, LOOKS

_PIXELS = 1024  # of what changes along a component


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
    made = bundled("materials", made_of.label)
    made.name, nodes = name, made.node_tree.nodes
    share = np.linspace(0.0, 1.0, 2) if along is None else along
    places = np.interp(np.arange(_PIXELS) / _PIXELS, np.linspace(0.0, 1.0, len(share)), share)
    length = sum(spline.calc_length() for spline in data.splines) / len(data.splines)
    radius = data.bevel_depth or length / 60.0
    tint = made_of.palette[hue % len(made_of.palette)]
    made.diffuse_color = (*flatly_lit(np.array(tint)), 1.0)
    if hue == len(made_of.palette):
        stops = np.array((*made_of.gradient, made_of.gradient[0]))
        colours = [np.interp(places * (len(stops) - 1), np.arange(len(stops)), channel) for channel in stops.T]
        nodes["gradient"].image = _table(f"{name} Colors", np.array(colours).T)
        _tint_by(made, nodes["gradient"])
    else:
        tinted = [link.to_socket for link in nodes["tint"].outputs[0].links]
        for node in ("tint", "gradient"):
            if node in nodes:
                nodes.remove(nodes[node])
        for socket in tinted:
            socket.default_value = (*tint, 1.0)[: len(socket.default_value)]
    if "share" in nodes:
        nodes["share"].image = _table(f"{name} Places", np.column_stack(3 * [places]))
    if "lay" in nodes:  # of a rope
        turns = 0.2 * np.pi * max(round(length / (1.55 * radius)), 3)  # the pitch of its strands, in its radii
        nodes["lay"].inputs["Scale"].default_value = (turns, 0.6 * np.pi, 0.0)
        # how far strands and their yarns stand out
        for bump, distance in (("bump", 0.5 * radius), ("fine", 0.08 * radius)):
            inputs = nodes[bump].inputs
            inputs["Distance"].default_value = distance
            if "Filter Width" in inputs:  # Blender 5.0 and later, which give files of 4.2 a wider one
                inputs["Filter Width"].default_value = 0.1  # pixels
    return made


def vertex_colours(attribute: str) -> bpy.types.Material:
    """A material whose colour is an attribute of the mesh; the existing one of that name if there is one."""
    name = f"Glaze {attribute}"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    made = bundled("materials", LOOKS[DEFAULT].label)
    made.name, nodes = name, made.node_tree.nodes
    nodes.remove(nodes["gradient"])
    colours = nodes.new("ShaderNodeVertexColor")
    colours.name, colours.layer_name = "colors", attribute
    _tint_by(made, colours)
    return made


def _tint_by(made: bpy.types.Material, node: bpy.types.Node) -> None:
    """Let a node tint a look's material, and be what Workbench shows."""
    tree = made.node_tree
    for link in list(tree.nodes["tint"].outputs[0].links):
        tree.links.new(node.outputs["Color"], link.to_socket)
    tree.nodes.remove(tree.nodes["tint"])
    tree.nodes.active = node


def _table(name: str, rows: FloatArray) -> bpy.types.Image:
    """An image one pixel high, which is read along a component by its texture coordinates; rows of RGB."""
    pixels = np.ones((len(rows), 4), dtype=np.float32)
    pixels[:, :3] = rows
    image = bpy.data.images.new(name, len(rows), 1, float_buffer=True)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image
