"""The table's knots as artists pick them: labels, groups that are not too large, and small pictures.

Pictures are drawn with NumPy alone: tubes under a light, seen from +z.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from types import MappingProxyType

import numpy as np

from ...core import Curve
from ...core.knots import ALIASES, KNOTS
from ...core.types import FloatArray, IntArray
from .colours import PALETTE, flatly_lit, on_screen

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
_HALF = 83  # of the 165 knots with ten crossings

_TINTS = on_screen(flatly_lit(np.array(PALETTE)))
_RADIUS, _RIM = 0.075, 0.035  # of the tube and of the dark rim that sets it off from what is behind; half-widths
_FILL = 0.88  # of the picture's width
_STEP = 0.3  # of the radius, from one ball of the tube to the next
_BEHIND = 2.5  # of the radius: a rim hides what is this far behind it
_LIGHT = np.array([-0.35, 0.5, 0.79])
_AMBIENT = 0.35
_RIM_COLOR = 0.08


def group(name: str) -> str:
    """The group that a knot of the table is in."""
    crossings, _, number = name.partition("_")
    if not number:
        return "LINKS"
    if int(crossings) <= 7:
        return "FEW"
    return crossings if crossings != "10" else "10A" if int(number) <= _HALF else "10B"


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


def thumbnail(curve: Curve, size: int) -> FloatArray:
    """Draw a curve as tubes, one colour for each component; RGBA in [0, 1], bottom row first, (size, size, 4).

    The tube is drawn as balls, each of which covers the pixels behind it; it is transparent around the tube.
    """
    low, high = curve.vertices.min(axis=0), curve.vertices.max(axis=0)
    room = 1.0 + _RADIUS + _RIM
    unit = 0.5 * _FILL * size / room
    scale = unit / (0.5 * float((high - low)[:2].max()))
    points, component = _along(
        curve.with_vertices((curve.vertices - 0.5 * (low + high)) * scale), _STEP * _RADIUS * unit
    )
    points[:, :2] += 0.5 * size
    picture = np.zeros((size, size, 4))
    depth = np.full((size, size), -np.inf)
    for radius, sink in (((_RADIUS + _RIM) * unit, _BEHIND * _RADIUS * unit), (_RADIUS * unit, 0.0)):
        rows, columns, height, normal, which = _balls(points, component, radius, size)
        seen = _topmost(rows, columns, height - sink, depth)
        rows, columns = rows[seen], columns[seen]
        brightness = _AMBIENT + (1.0 - _AMBIENT) * np.maximum(normal[seen] @ _LIGHT, 0.0)
        colors = _TINTS[which[seen] % len(_TINTS)] * brightness[:, None]
        picture[rows, columns] = np.column_stack([colors if not sink else colors * _RIM_COLOR, np.ones(len(rows))])
    return picture


def _along(curve: Curve, spacing: float) -> tuple[FloatArray, IntArray]:
    """Points on a curve no further apart than ``spacing``, and their components."""
    pieces = np.ceil(curve.edge_lengths / spacing).astype(np.intp)
    edge = np.repeat(np.arange(len(curve)), pieces)
    t = (np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[edge]
    return curve.vertices[edge] + t[:, None] * curve.edge_vectors[edge], curve.mesh.component[edge]


def _balls(
    points: FloatArray, component: IntArray, radius: float, size: int
) -> tuple[IntArray, IntArray, FloatArray, FloatArray, IntArray]:
    """Pixels that balls cover: rows, columns, heights of the surface there, its unit normals, and components."""
    reach = np.arange(-int(radius) - 1, int(radius) + 2)
    offsets = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
    pixels = np.floor(points[:, None, :2]).astype(np.intp) + offsets
    apart = pixels + 0.5 - points[:, None, :2]
    rise = radius**2 - (apart**2).sum(axis=2)
    ball, place = np.nonzero((rise > 0) & ((pixels >= 0) & (pixels < size)).all(axis=2))
    across, up = apart[ball, place], np.sqrt(rise[ball, place])
    columns, rows = pixels[ball, place].T
    normal = np.column_stack([across, up]) / radius
    return rows, columns, points[ball, 2] + up, normal, component[ball]


def _topmost(rows: IntArray, columns: IntArray, height: FloatArray, depth: FloatArray) -> IntArray:
    """The balls that cover what is there, one for each pixel; their heights replace the old ones."""
    order = np.argsort(height)
    last = np.full(depth.shape, -1, dtype=np.intp)
    last[rows[order], columns[order]] = order  # of several values assigned to a pixel the last one stays
    chosen = last[last >= 0]
    chosen = chosen[height[chosen] > depth[rows[chosen], columns[chosen]]]
    depth[rows[chosen], columns[chosen]] = height[chosen]
    return np.asarray(chosen)
