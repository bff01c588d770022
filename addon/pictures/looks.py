"""Looks: each is what a stage and the curves on it are made of, as data; `stage` and `materials` build them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..engine.colours import PALETTE

Tint = tuple[float, float, float]  # linear RGB
# shader nodes by their names: type, values of inputs or "node.output" that feeds them, and other settings
Nodes = Mapping[str, tuple[str, Mapping[Any, Any], Mapping[str, Any]]]

SHADER = "Principled BSDF"
# placeholders among values for a component's colour, for the shares of the length along and around the tube, and for
# the turns of a rope's strands and how far they and their yarns stand out
TINT, ALONG, TURNS, STRAND, YARN = "tint", "along", "turns", "strand", "yarn"


@dataclass(frozen=True)
class Light:
    """A square light; its place, width and power are in units of the stage's size."""

    at: Tint
    width: float
    power: float
    tint: Tint = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Look:
    """A stage, what tubes are made of, and how they are rendered."""

    label: str
    description: str
    palette: tuple[Tint, ...]  # of components; after the last they begin again
    gradient: tuple[Tint, ...]  # along a single component, round and round; the palette's first if empty
    shader: Mapping[str, Any]  # inputs of tubes' Principled BSDF; a word is a node's output
    floor: Tint
    floor_roughness: float
    sky: Tint  # times its strength
    lights: tuple[Light, ...]  # the key light first
    nodes: Nodes = field(default_factory=dict)  # that feed the shader
    exposure: float = 0.0
    bounces: int = 3
    samples: int = 32

    @property
    def uses_place(self) -> bool:
        """Whether its nodes depend on the position on the tube."""
        return any(ALONG in inputs.values() for _, inputs, _ in self.nodes.values())


_ROPE: Nodes = {
    # three strands: twisted bands, whose phase 20 x is a whole number of turns along the rope and three around it
    "lay": ("ShaderNodeMapping", {"Vector": ALONG, "Scale": TURNS}, {}),
    "strands": ("ShaderNodeTexWave", {"Vector": "lay.Vector", "Scale": 1.0}, {"bands_direction": "DIAGONAL"}),
    "yarn": ("ShaderNodeVectorMath", {0: "lay.Vector", 1: (-2.0, 9.0, 0.0)}, {"operation": "MULTIPLY"}),
    "yarns": ("ShaderNodeTexWave", {"Vector": "yarn.Vector", "Scale": 1.0}, {"bands_direction": "DIAGONAL"}),
    "fine": ("ShaderNodeBump", {"Height": "yarns.Fac", "Strength": 0.5, "Distance": YARN}, {}),
    "bump": ("ShaderNodeBump", {"Height": "strands.Fac", "Normal": "fine.Normal", "Distance": STRAND}, {}),
    "grooves": ("ShaderNodeMapRange", {"Value": "strands.Fac", "From Max": 0.3, "To Min": 0.3, "To Max": 1.0}, {}),
    "shade": ("ShaderNodeVectorMath", {0: TINT, "Scale": "grooves.Result"}, {"operation": "SCALE"}),
}

LOOKS = {
    "STUDIO": Look(
        "Dark Studio",
        "Glazed tubes before a dark ground, with light from behind",
        palette=((0.02, 0.24, 0.50), (0.78, 0.10, 0.05), (0.85, 0.46, 0.05), (0.10, 0.42, 0.22), (0.40, 0.12, 0.50)),
        gradient=((0.02, 0.20, 0.46), (0.03, 0.42, 0.42), (0.80, 0.42, 0.08), (0.76, 0.12, 0.06), (0.30, 0.06, 0.36)),
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
        "Colored clay on white paper, in daylight",
        palette=PALETTE,
        gradient=((0.01, 0.10, 0.24), (0.02, 0.24, 0.26), (0.72, 0.36, 0.05), (0.62, 0.07, 0.03), (0.20, 0.04, 0.24)),
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
        "Glowing tubes over a dark, shining floor",
        palette=((0.01, 0.22, 1.0), (1.0, 0.01, 0.16), (1.0, 0.26, 0.01), (0.02, 0.7, 0.14), (0.42, 0.02, 1.0)),
        gradient=((0.01, 0.18, 1.0), (0.36, 0.02, 1.0), (1.0, 0.01, 0.22), (1.0, 0.24, 0.01), (0.01, 0.55, 0.40)),
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
        "Laid rope on dark slate",
        palette=((0.62, 0.42, 0.22), (0.50, 0.05, 0.03), (0.05, 0.16, 0.34), (0.72, 0.66, 0.55), (0.08, 0.24, 0.12)),
        gradient=(),
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
        "Tinted glass, which shows what is behind it",
        palette=((0.10, 0.55, 0.95), (1.0, 0.20, 0.14), (1.0, 0.68, 0.12), (0.20, 0.85, 0.40), (0.60, 0.28, 0.95)),
        gradient=((0.08, 0.45, 0.95), (0.12, 0.85, 0.72), (1.0, 0.70, 0.16), (1.0, 0.25, 0.18), (0.56, 0.24, 0.92)),
        shader={
            "Base Color": TINT,
            "Roughness": 0.02,
            "Transmission Weight": 0.8,
            "IOR": 1.4,
            "Alpha": "clear.Result",
        },
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
        bounces=8,
        samples=64,
    ),
}
DEFAULT = "PAPER"
