"""Materials: glazes of one colour, and one that shows the colours of a mesh's vertices."""

from typing import TYPE_CHECKING

import numpy as np

from ..engine.colours import PALETTE, flatly_lit

if TYPE_CHECKING:
    import bpy

_GLAZE = {"Roughness": 0.32, "Coat Weight": 0.6, "Coat Roughness": 0.08}


def colour_components(data: "bpy.types.Curve", first: int = 0) -> None:
    """Give every spline the colour of its component, the ``first`` onwards, in slots after those that there are."""
    slots: dict[int, int] = {}
    for component, spline in enumerate(data.splines, first):
        hue = component % len(PALETTE)
        if hue not in slots:
            slots[hue] = _slot(data, _glaze(hue))
        spline.material_index = slots[hue]


def vertex_colours(attribute: str) -> "bpy.types.Material":
    """A material whose colour is an attribute of the mesh; the one of that name if there is one already."""
    import bpy

    name = f"Glaze {attribute}"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    made = material(name, (0.2, 0.2, 0.2), _GLAZE)
    nodes = made.node_tree.nodes
    colour = nodes.new("ShaderNodeVertexColor")
    colour.layer_name, colour.location = attribute, (-220, 280)
    made.node_tree.links.new(colour.outputs["Color"], _shader(made).inputs["Base Color"])
    return made


def material(name: str, tint: tuple[float, float, float], values: dict[str, float]) -> "bpy.types.Material":
    """A new material of one colour; ``values`` are its shader's other inputs."""
    import bpy

    made = bpy.data.materials.new(name)
    made.diffuse_color = (*flatly_lit(np.array(tint)), 1.0)
    made.roughness = values["Roughness"]
    if made.node_tree is None:  # from Blender 5.0 on there is one from the start, and the switch is deprecated
        made.use_nodes = True
    shader = _shader(made)
    shader.inputs["Base Color"].default_value = (*tint, 1.0)
    for socket, value in values.items():
        shader.inputs[socket].default_value = value
    return made


def _glaze(hue: int) -> "bpy.types.Material":
    """The glaze of a component; the one that is there already if there is one, as other objects may have it."""
    import bpy

    name = f"Glaze {hue + 1}"
    return bpy.data.materials.get(name) or material(name, PALETTE[hue], _GLAZE)


def _slot(data: "bpy.types.Curve", wanted: "bpy.types.Material") -> int:
    if wanted.name not in data.materials:
        data.materials.append(wanted)
    return int(data.materials.find(wanted.name))


def _shader(made: "bpy.types.Material") -> "bpy.types.Node":
    return next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
