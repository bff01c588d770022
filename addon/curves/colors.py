"""A colour for each component of a link."""

from typing import TYPE_CHECKING

import numpy as np

from ..engine.thumbnail import COLORS

if TYPE_CHECKING:
    import bpy


def color_components(data: "bpy.types.Curve") -> None:
    """Give each spline of new curve data a material of its own, the same ones for all links."""
    for k, spline in enumerate(data.splines):
        if k < len(COLORS):
            data.materials.append(_material(k))
        spline.material_index = k % len(COLORS)


def _material(k: int) -> "bpy.types.Material":
    """The material of the k-th component; what the user made of it is kept."""
    import bpy

    name = f"Knot Component {k + 1}"
    found = bpy.data.materials.get(name)
    if found is not None:
        return found
    material = bpy.data.materials.new(name)
    color = (*(np.asarray(COLORS[k]) ** 2.2).tolist(), 1.0)  # from sRGB, nearly
    material.diffuse_color = color
    for node in material.node_tree.nodes if material.node_tree else ():
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = color
    return material
