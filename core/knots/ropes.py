"""Knots as they are tied in ropes, loosely and with open ends: splines through points of their drawings."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from ..base import CurveError, FloatArray
from ..curve import Curve, cubic_spline, evenly
from .inscribed import shares


def _drawn(*ropes: str) -> list[FloatArray]:
    return [np.array([point.split() for point in rope.split(",")], dtype=float) for rope in ropes]


# points x y z along each rope: it crosses over others where z is 1, and under them where z is -1
_FIGURE_EIGHT = _drawn(
    "-16 0 0, -8 0 0, -4 0 1, 0 0 -1, 3 -2 0, 6 1 1, 5.5 3.4 0, 2.5 2.8 -1, 0 0 1, -2 -2.6 0, -4 0 -1, -1.5 3 0,"
    "2.5 2.8 1, 6 1 -1, 10 0 0, 16 0 0"
)
_SHEET_BEND = _drawn(
    "-16 -1.2 0, -7 -1.2 0, -4 -1.2 1, 2 -3 -1, 4 -2.6 0, 5 0 1, 4.4 2.4 0, 2 3.2 -1, -1 2.2 -1, -4 1.2 1, -7 1.2 0,"
    "-16 1.2 0",
    "16 0 0, 8 0 0, 5 0 -1, 2 0.6 1, -1 2.2 1, -3.4 3.4 0, -4.2 1.2 -1, -4.2 -1.2 -1, -3 -4 0, 1 -4.4 0, 2 -3 1,"
    "2 0.6 -1, 2 3.2 1, 4 6 0, 8 6 0, 16 6 0",
)
# a bowline is a sheet bend in one rope, whose bight goes on into the turn around it, by a loop around the free end
_LOOP, _END = _drawn("3.5 5 0, 1 6 0, -4 6 0, -8 4 0, -9 1.2 1, -7.5 -1.2 0", "-9 1.2 -1, -14 1.2 0")
_BOWLINE = [np.concatenate([_SHEET_BEND[1][:-3], _LOOP, _SHEET_BEND[0][2:-2], _END])]
# square knots and grannies are two bights, each turned over into the other; bights are symmetric, by reflection in
# square knots, by half a turn in grannies
[_LEG] = _drawn("-20 1.2 0, -7 1.2 0, -4 1.2 -1, 0 2.4 1, 3 3.2 0, 4.4 1.2 -1")
_SQUARE, _GRANNY = (
    [bight, bight * [-1.0, 1.0, -1.0]]
    for bight in (np.concatenate([_LEG, _LEG[::-1] * [1.0, -1.0, side]]) for side in (1.0, -1.0))
)


def _tied(ropes: list[FloatArray], vertices: int | None) -> Curve:
    """The loose knot with this number of vertices, by default 200; a CurveError for fewer than 100."""
    count = 200 if vertices is None else vertices
    if count < 100:
        raise CurveError(f"{count} vertices are too few for this knot; give 100 or more")
    splines = [cubic_spline(points, closed=False) for points in ropes]
    fine = [spline(np.linspace(0.0, spline.x[-1], 4000)) for spline in splines]
    opened = (False,) * len(ropes)
    sizes = shares(count, Curve.from_components(fine, opened).component_lengths)
    return Curve.from_components([evenly(*each) for each in zip(fine, opened, sizes, strict=True)], opened)


ROPES: Mapping[str, Callable[[int | None], Curve]] = {
    "open-figure-eight": partial(_tied, _FIGURE_EIGHT),
    "open-square": partial(_tied, _SQUARE),
    "open-granny": partial(_tied, _GRANNY),
    "sheet-bend": partial(_tied, _SHEET_BEND),
    "bowline": partial(_tied, _BOWLINE),
}
"""Knots in ropes with two or four open ends, to be pulled tight."""
