#!/usr/bin/env python3
"""Make addon/assets/looks.blend: what looks are made of; run it in Blender 4.2, whose files all later ones load.

For each look a material of tubes, one of the floor, a world, and a collection of lights around a stage of size 1 with
the axes of the world. In a tube's material the extension sets by their names: "tint", the colour of a component, or
"gradient" in its place; "share", "lay", "fine" and "bump", what depends on a curve's length and thickness.
"""

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

TARGET = Path(__file__).resolve().parents[1] / "addon" / "assets" / "looks.blend"

Tint = tuple[float, float, float]  # linear RGB
# shader nodes by their names: type, values of inputs or "node.output" that feeds them, and other settings
Nodes = Mapping[str, tuple[str, Mapping[Any, Any], Mapping[str, Any]]]

SHADER = "Principled BSDF"
# the words among values for a component's colour and for its shares of the length along and around the tube
TINT, ALONG = "tint.Color", "place.Vector"


@dataclass(frozen=True)
class Light:
    """A square light; its place, width and power are in units of the stage's size."""

    at: Tint
    width: float
    power: float
    tint: Tint = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Look:
    """A stage, and what tubes are made of."""

    label: str
    gradient: bool  # whether a component that is alone has one
    shader: Mapping[str, Any]  # inputs of tubes' Principled BSDF; a word is a node's output
    floor: Tint
    floor_roughness: float
    sky: Tint  # times its strength
    lights: tuple[Light, ...]  # the key light first
    nodes: Nodes = field(default_factory=dict)  # that feed the shader


_ROPE: Nodes = {
    # three strands: twisted bands, whose phase 20 x is a whole number of turns along the rope and three around it
    "lay": ("ShaderNodeMapping", {"Vector": ALONG}, {}),
    "strands": ("ShaderNodeTexWave", {"Vector": "lay.Vector", "Scale": 1.0}, {"bands_direction": "DIAGONAL"}),
    "yarn": ("ShaderNodeVectorMath", {0: "lay.Vector", 1: (-2.0, 9.0, 0.0)}, {"operation": "MULTIPLY"}),
    "yarns": ("ShaderNodeTexWave", {"Vector": "yarn.Vector", "Scale": 1.0}, {"bands_direction": "DIAGONAL"}),
    "fine": ("ShaderNodeBump", {"Height": "yarns.Fac", "Strength": 0.5}, {}),
    "bump": ("ShaderNodeBump", {"Height": "strands.Fac", "Normal": "fine.Normal"}, {}),
    "grooves": ("ShaderNodeMapRange", {"Value": "strands.Fac", "From Max": 0.3, "To Min": 0.3, "To Max": 1.0}, {}),
    "shade": ("ShaderNodeVectorMath", {0: TINT, "Scale": "grooves.Result"}, {"operation": "SCALE"}),
}

LOOKS: Mapping[str, Look] = {
    "STUDIO": Look(
        "Dark Studio",
        gradient=True,
        shader={"Base Color": TINT, "Roughness": 0.28, "Coat Weight": 0.5, "Coat Roughness": 0.12},
        floor=(0.018, 0.020, 0.024),
        floor_roughness=0.5,
        sky=(0.018, 0.022, 0.032),
        lights=(
            Light((-1.6, 0.4, 2.6), 1.8, 55.0, (1.0, 0.94, 0.86)),
            Light((1.7, 2.4, 1.5), 1.2, 60.0, (0.75, 0.87, 1.0)),
            Light((0.5, -3.0, 1.6), 2.2, 14.0, (1.0, 0.9, 0.8)),
        ),
    ),
    "PAPER": Look(
        "Paper",
        gradient=True,
        shader={"Base Color": TINT, "Roughness": 0.45, "Coat Weight": 0.3, "Coat Roughness": 0.2},
        floor=(0.88, 0.85, 0.80),
        floor_roughness=0.9,
        sky=(0.36, 0.39, 0.43),
        lights=(
            Light((-1.5, 0.7, 2.5), 1.2, 62.0, (1.0, 0.95, 0.88)),
            Light((1.9, 1.9, 1.5), 0.8, 12.0, (0.80, 0.90, 1.0)),
        ),
    ),
    "NEON": Look(
        "Neon",
        gradient=True,
        shader={
            "Base Color": (0.0, 0.0, 0.0, 1.0),
            "Roughness": 0.3,
            "Emission Color": TINT,
            "Emission Strength": "glow.Result",
        },
        nodes={  # dark edges show which strand is in front
            "facing": ("ShaderNodeLayerWeight", {"Blend": 0.5}, {}),
            "glow": (
                "ShaderNodeMapRange",
                {"Value": "facing.Facing", "From Min": 0.3, "From Max": 0.85, "To Min": 1.2, "To Max": 0.03},
                {},
            ),
        },
        floor=(0.07, 0.07, 0.09),
        floor_roughness=0.32,
        sky=(0.006, 0.007, 0.012),
        lights=(Light((-1.4, 1.2, 2.4), 2.0, 14.0, (0.6, 0.7, 1.0)),),
    ),
    "ROPE": Look(
        "Rope",
        gradient=False,
        shader={"Base Color": "shade.Vector", "Roughness": 0.85, "Normal": "bump.Normal"},
        nodes=_ROPE,
        floor=(0.055, 0.075, 0.095),
        floor_roughness=0.7,
        sky=(0.10, 0.12, 0.15),
        lights=(
            Light((-1.7, 0.6, 2.0), 0.9, 75.0, (1.0, 0.92, 0.80)),
            Light((1.9, 1.9, 1.5), 1.2, 22.0, (0.75, 0.87, 1.0)),
        ),
    ),
    "GLASS": Look(
        "Glass",
        gradient=True,
        shader={"Base Color": TINT, "Roughness": 0.02, "Transmission Weight": 0.8, "IOR": 1.4, "Alpha": "clear.Result"},
        nodes={  # shadows of glass are not black
            "path": ("ShaderNodeLightPath", {}, {}),
            "clear": ("ShaderNodeMapRange", {"Value": "path.Is Shadow Ray", "To Min": 1.0, "To Max": 0.3}, {}),
        },
        floor=(0.80, 0.82, 0.84),
        floor_roughness=0.6,
        sky=(0.62, 0.66, 0.72),
        lights=(
            Light((-1.5, 1.0, 2.4), 1.0, 55.0, (1.0, 0.96, 0.9)),
            Light((1.8, 1.8, 1.2), 0.7, 26.0, (0.85, 0.93, 1.0)),
        ),
    ),
}


def main() -> int:
    """Make all looks in an empty file, and write them."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blocks = set[bpy.types.ID]()
    for look in LOOKS.values():
        nodes = {"tint": ("ShaderNodeRGB", {}, {}), **look.nodes}
        if look.gradient:
            nodes["gradient"] = ("ShaderNodeTexImage", {}, {})
        if any(ALONG in inputs.values() for _, inputs, _ in look.nodes.values()):
            nodes |= {
                "share": ("ShaderNodeTexImage", {}, {"extension": "EXTEND"}),
                "uv": ("ShaderNodeUVMap", {}, {}),
                "sides": ("ShaderNodeSeparateXYZ", {"Vector": "uv.UV"}, {}),
                "place": ("ShaderNodeCombineXYZ", {"X": "share.Color", "Y": "sides.Y"}, {}),
            }
        tube = material(look.label, look.shader, nodes)
        floor = material(
            f"{look.label} Floor", {"Base Color": (*look.floor, 1.0), "Roughness": look.floor_roughness}, {}
        )
        world = bpy.data.worlds.new(look.label)
        world.use_nodes = True
        background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
        background.inputs["Color"].default_value = (*look.sky, 1.0)
        background.inputs["Strength"].default_value = 1.0
        lights = bpy.data.collections.new(look.label)
        for light in look.lights:
            data = bpy.data.lights.new("Light" if lights.objects else "Key", "AREA")
            data.size, data.energy, data.color = light.width, light.power, light.tint
            # it shines along its −z axis, at the middle, and its y axis is up
            backward = np.array(light.at) / np.linalg.norm(light.at)
            right = np.cross([0.0, 0.0, 1.0], backward)
            right /= np.linalg.norm(right)
            turned = np.column_stack([right, np.cross(backward, right), backward, light.at])
            obj = bpy.data.objects.new(f"{look.label} {data.name}", data)
            obj.matrix_basis = Matrix([*turned.tolist(), [0.0, 0.0, 0.0, 1.0]])
            lights.objects.link(obj)
        blocks |= {tube, floor, world, lights}
    bpy.data.libraries.write(str(TARGET), blocks, fake_user=True, compress=True)
    return 0


def material(name: str, shader: Mapping[str, Any], nodes: Nodes) -> bpy.types.Material:
    """A new material: inputs of its shader, and nodes that feed them."""
    made = bpy.data.materials.new(name)
    made.roughness = shader["Roughness"]
    if tint := shader.get("Base Color") if not nodes else None:
        made.diffuse_color = (*(np.array(tint[:3]) ** 0.65), 1.0)  # as core.keys.colours.flatly_lit
    made.use_nodes = True
    tree = made.node_tree
    found = {SHADER: next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")}
    for k, (title, (kind, _, settings)) in enumerate(nodes.items(), 1):
        found[title] = tree.nodes.new(kind)
        found[title].name, found[title].location = title, (-220 * k, 300)
        for setting, value in settings.items():
            setattr(found[title], setting, value)
    for title, inputs in {SHADER: shader, **{title: inputs for title, (_, inputs, _) in nodes.items()}}.items():
        for socket, value in inputs.items():
            fed = found[title].inputs[socket]
            if isinstance(value, str):
                node, output = value.split(".")
                tree.links.new(tree.nodes[node].outputs[output], fed)
            else:
                fed.default_value = value
    return made


if __name__ == "__main__":
    sys.exit(main())
