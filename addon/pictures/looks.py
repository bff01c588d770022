"""Looks: the colours and settings of each; what it is made of is in assets/assets.blend, for artists to change."""

from dataclasses import dataclass

from ...core.keys.colours import PALETTE

Tint = tuple[float, float, float]  # linear RGB


@dataclass(frozen=True)
class Look:
    """What a look is called, its colours, and how it is rendered."""

    label: str  # and the name of what it has in the file
    description: str
    palette: tuple[Tint, ...]  # of components; after the last they begin again
    gradient: tuple[Tint, ...]  # along a single component, round and round; the palette's first if empty
    floor: Tint
    bounces: int = 3
    samples: int = 32


LOOKS = {
    "STUDIO": Look(
        "Dark Studio",
        "Glazed tubes before a dark ground, with light from behind",
        palette=((0.02, 0.24, 0.50), (0.78, 0.10, 0.05), (0.85, 0.46, 0.05), (0.10, 0.42, 0.22), (0.40, 0.12, 0.50)),
        gradient=((0.02, 0.20, 0.46), (0.03, 0.42, 0.42), (0.80, 0.42, 0.08), (0.76, 0.12, 0.06), (0.30, 0.06, 0.36)),
        floor=(0.018, 0.020, 0.024),
    ),
    "PAPER": Look(
        "Paper",
        "Colored clay on white paper, in daylight",
        palette=PALETTE,
        gradient=((0.01, 0.10, 0.24), (0.02, 0.24, 0.26), (0.72, 0.36, 0.05), (0.62, 0.07, 0.03), (0.20, 0.04, 0.24)),
        floor=(0.88, 0.85, 0.80),
    ),
    "NEON": Look(
        "Neon",
        "Glowing tubes over a dark, shining floor",
        palette=((0.01, 0.22, 1.0), (1.0, 0.01, 0.16), (1.0, 0.26, 0.01), (0.02, 0.7, 0.14), (0.42, 0.02, 1.0)),
        gradient=((0.01, 0.18, 1.0), (0.36, 0.02, 1.0), (1.0, 0.01, 0.22), (1.0, 0.24, 0.01), (0.01, 0.55, 0.40)),
        floor=(0.07, 0.07, 0.09),
    ),
    "ROPE": Look(
        "Rope",
        "Laid rope on dark slate",
        palette=((0.62, 0.42, 0.22), (0.50, 0.05, 0.03), (0.05, 0.16, 0.34), (0.72, 0.66, 0.55), (0.08, 0.24, 0.12)),
        gradient=(),
        floor=(0.055, 0.075, 0.095),
    ),
    "GLASS": Look(
        "Glass",
        "Tinted glass, which shows what is behind it",
        palette=((0.10, 0.55, 0.95), (1.0, 0.20, 0.14), (1.0, 0.68, 0.12), (0.20, 0.85, 0.40), (0.60, 0.28, 0.95)),
        gradient=((0.08, 0.45, 0.95), (0.12, 0.85, 0.72), (1.0, 0.70, 0.16), (1.0, 0.25, 0.18), (0.56, 0.24, 0.92)),
        floor=(0.80, 0.82, 0.84),
        bounces=8,
        samples=64,
    ),
}
DEFAULT = "PAPER"
ON_STAGE = "STUDIO"  # where an artist asks for none: thin tubes are seen well on a dark ground
