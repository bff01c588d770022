#!/usr/bin/env python3
"""Render docs/pictures: looks.png, a knot in each look, and morph.png.

Each part is rendered in a few seconds of processor time: `looks_pictures.py NAME` renders one of the pictures only.
The moving picture is a film, as ffmpeg makes it smaller:

    mobius-flow relax examples/tangle.obj untangle.mp4
    ffmpeg -i untangle.mp4 -vf fps=15,scale=480:-1 -c:v libwebp -loop 0 -quality 55 docs/pictures/untangle.webp
"""

import sys
import tempfile
from pathlib import Path

from mobius_flow.addon.pictures.export import write_picture
from mobius_flow.addon.pictures.looks import LOOKS
from mobius_flow.core import Iterate, minimize, morph
from mobius_flow.core.curve import Curve
from mobius_flow.core.knots import knot
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
LEGS = (0, 20, 44, 64, 108, -1)  # of the morph, where tubes are about as thick in the picture
COLORS = 256


def looks() -> list[tuple[Curve, str]]:
    """The same knot again and again."""
    curve = minimize(knot("5_1")).curve
    return [(curve, look) for look in LOOKS]


def unknots() -> list[tuple[Curve, str]]:
    """One famous unknot on its way to another."""
    iterates: list[Iterate] = []
    morph(knot("ochiai-1"), knot("thistlethwaite"), callback=iterates.append)
    return [(iterates[k].curve, "STUDIO") for k in LEGS]


PICTURES = {"looks": (looks, 300, 5), "morph": (unknots, 300, 3)}  # side, columns


def strip(name: str) -> None:
    """Put the parts of a picture in rows, with few colours, in a third of the space."""
    make, side, columns = PICTURES[name]
    parts = make()
    whole = Image.new("RGB", (side * columns, side * -(-len(parts) // columns)))
    with tempfile.TemporaryDirectory() as room:
        for k, (curve, look) in enumerate(parts):
            write_picture(Path(room, "part.png"), curve, side, side, look)
            whole.paste(
                Image.open(Path(room, "part.png")).convert("RGB"), (side * (k % columns), side * (k // columns))
            )
    palette = whole.quantize(COLORS, Image.Quantize.MAXCOVERAGE, kmeans=30)
    small = whole.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    small.save(ROOT / "docs" / "pictures" / f"{name}.png", optimize=True)


if __name__ == "__main__":
    for wanted in sys.argv[1:] or PICTURES:
        strip(wanted)
