"""Knotted arcs: open polygons that ends may slip out of."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from ..arguments import checked
from ..curve import Curve, Mesh
from ..curve.smooth import arc_lengths
from ..errors import CurveError
from ..types import FloatArray

_REACH = 2.1  # of the parameter: beyond it the curve is all but straight
_FLATNESS = 0.1  # of the third coordinate
_ENDS = 3.0  # length of the straight ends
_SAMPLES = 2000
DEFAULT, LEAST = 120, 40  # vertices


@checked
def overhand(vertices: int | None = None) -> Curve:
    """The overhand knot, a trefoil that is cut open, with straight ends.

    Shastri's polynomials (t³ − 3t, t⁴ − 4t², t⁵ − 10t), of which the last one is scaled down.

    Parameters
    ----------
    vertices
        Their number; by default 120.

    Raises
    ------
    CurveError
        If there are fewer than 40, with which the arc might be another one.

    Examples
    --------
    >>> overhand(60).mesh.closed
    (False,)
    """
    count = DEFAULT if vertices is None else vertices
    if count < LEAST:
        raise CurveError(f"{count} vertices are too few for this arc; give {LEAST} or more")
    points = _with_straight_ends(_polynomials(np.linspace(-_REACH, _REACH, _SAMPLES)))
    arc = arc_lengths(points)
    places = np.linspace(0.0, arc[-1], count)
    return Curve(np.stack([np.interp(places, arc, x) for x in points.T], axis=1), Mesh((count,), (False,)))


def _polynomials(t: FloatArray) -> FloatArray:
    return np.stack([t**3 - 3.0 * t, t**4 - 4.0 * t**2, _FLATNESS * (t**5 - 10.0 * t)], axis=1)


def _with_straight_ends(points: FloatArray) -> FloatArray:
    """The curve with a segment along its tangent at either end."""
    before, after = points[0] - points[1], points[-1] - points[-2]
    ends = points[0] + _ENDS * before / np.linalg.norm(before), points[-1] + _ENDS * after / np.linalg.norm(after)
    return np.concatenate([ends[0][None], points, ends[1][None]])


ARCS: Mapping[str, Callable[[int | None], Curve]] = MappingProxyType({"overhand": overhand})
"""Arcs with names."""
