"""The table's knots as artists pick them: labels, groups that are not too large, and icons.

Icons are cut from the sheet that tools/knot_icons.py draws, when they are first asked for.
"""

import zlib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType

import bpy
import bpy.utils.previews
import numpy as np
import numpy.typing as npt

from ...core.base import FloatArray
from ...core.knots import ALIASES, KNOTS

SHEET = Path(__file__).parents[1] / "assets" / "knots.png"
COLUMNS, SIDE = 16, 96  # squares in a row of the sheet, and pixels of a square's sides
COMMON: Sequence[str] = ("0_1", "3_1", "4_1", "5_1", "5_2", "6_1", "7_4", "L2a1", "L4a1", "L5a1", "L6a4")
"""What most people look for."""

GROUPS: Mapping[str, tuple[str, str]] = {
    "FEW": ("Up to 7 Crossings", "Knots that can be drawn with seven crossings or fewer"),
    "8": ("8 Crossings", "Knots that need eight crossings"),
    "9": ("9 Crossings", "Knots that need nine crossings"),
    "10A": ("10 Crossings, I", "The first knots that need ten crossings"),
    "10B": ("10 Crossings, II", "The other knots that need ten crossings"),
    "LINKS": ("Links", "Several closed curves, linked with each other"),
}
"""Titles and descriptions of the groups."""

_TITLES = {"solomon": "Solomon's Link", "hopf": "Hopf Link", "whitehead": "Whitehead Link", "perko": "Perko Pair"}
_TITLES |= {"borromean": "Borromean Rings", "figure eight": "Figure-Eight", "circle": ""}


def icon(name: str) -> int:
    """Number of the icon of a knot of the table; 0, which is no icon, where Blender has no window."""
    made = _made()
    if name not in made:
        preview, picture = made.new(name), cut(name)
        small = picture.reshape(SIDE // 3, 3, SIDE // 3, 3, 4).mean(axis=(1, 3))  # menus' icons have 32 pixels
        small[..., :3] /= np.maximum(small[..., 3:], 1.0 / 9.0)
        preview.icon_size, preview.image_size = small.shape[:2], picture.shape[:2]
        preview.icon_pixels_float.foreach_set(small.astype(np.float32).ravel())
        preview.image_pixels_float.foreach_set(picture.astype(np.float32).ravel())
    return int(made[name].icon_id)


def cut(name: str) -> FloatArray:
    """The picture of a knot of the table: RGBA in [0, 1], black where it is transparent, bottom row first."""
    numbers, colours = _sheet()
    down, right = divmod(list(KNOTS).index(name), COLUMNS)
    return np.asarray(colours[numbers[SIDE * down : SIDE * (down + 1), SIDE * right : SIDE * (right + 1)][::-1]])


def forget() -> None:
    """Remove all icons: Blender does not do so by itself."""
    if _made.cache_info().currsize:
        bpy.utils.previews.remove(_made())
        _made.cache_clear()
        _sheet.cache_clear()


@cache
def _made() -> bpy.utils.previews.ImagePreviewCollection:
    return bpy.utils.previews.new()


@cache
def _sheet() -> tuple[npt.NDArray[np.uint8], FloatArray]:
    """Numbers of colours, and the colours, RGBA (n, 4), of the sheet.

    It is a PNG with a palette, whose first colour is the transparent one, and without filters of rows. Blender itself
    would add an image to the user's file, which it does not allow while menus are drawn.
    """
    data, at, chunks = SHEET.read_bytes(), 8, dict[bytes, bytes]()
    while at < len(data):
        length, kind = int.from_bytes(data[at : at + 4], "big"), data[at + 4 : at + 8]
        chunks[kind] = chunks.get(kind, b"") + data[at + 8 : at + 8 + length]
        at += length + 12
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), dtype=np.uint8).reshape(-1, COLUMNS * SIDE + 1)
    colours = np.frombuffer(chunks[b"PLTE"], dtype=np.uint8).reshape(-1, 3) / 255.0
    return rows[:, 1:], np.column_stack([colours, np.arange(len(colours)) > 0])


def group(name: str) -> str:
    """The group that a knot of the table is in."""
    crossings, _, number = name.partition("_")
    if not number:
        return "LINKS"
    if int(crossings) <= 7:
        return "FEW"
    # half of the 165 knots with ten crossings
    return crossings if crossings != "10" else "10A" if int(number) <= 83 else "10B"


@cache
def labels() -> Mapping[str, str]:
    """The label of each knot of the table in lists, such as ``3_1 Trefoil``."""
    words: dict[str, str] = {}
    for alias, name in ALIASES.items():
        if title := _TITLES.get(alias, alias.title()):
            words.setdefault(name, title)
    return MappingProxyType({name: f"{name} {words[name]}" if name in words else name for name in KNOTS})


def name_of(label: str) -> str:
    """The name that a label begins with; anything else is returned unchanged."""
    first = label.split()[0] if label.split() else label
    return first if labels().get(first) == label.strip() else label
