"""Knots from formulas: Lissajous knots, and the overhand knot, an open arc that its ends may slip out of."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from ..arguments import checked
from ..curve import Curve, Mesh
from ..curve.smooth import evenly
from ..errors import CurveError
from ..types import FloatArray
from .inscribed import inscribed, strand_gap

MAX_FREQUENCY = 40  # beyond it, strands are too near to each other to be of any use
_SAMPLES = 160  # for each period of the fastest cosine: enough to represent the smooth curve
_REACH = 2.1  # of the overhand knot's parameter: beyond it the curve is all but straight
_FLATNESS = 0.1  # of its third coordinate, which grows with the fifth power
_ENDS = 3.0  # length of its straight ends; longer ones would need more vertices for the same knot
_LEAST = 40  # vertices with which the polygon is still knotted as the curve is


@checked
def lissajous_knot(
    frequencies: tuple[int, int, int],
    phases: tuple[float, float] = (0.7, 0.2),
    vertices: int | None = None,
    *,
    least_gap: float = 0.01,
) -> Curve:
    """Make the Lissajous knot (cos(a t + φ), cos(b t + ψ), cos(c t)), 0 ≤ t < 2π.

    Frequencies are positive, no two with a common divisor; phases are in radians.  Raises CurveError for others, and
    for strands nearer than ``least_gap``, below which default polygons would have thousands of vertices.
    """
    a, b, c = frequencies
    if not all(1 <= f <= MAX_FREQUENCY for f in frequencies) or max(math.gcd(a, b), math.gcd(b, c), math.gcd(a, c)) > 1:
        raise CurveError(
            f"frequencies are {a}, {b} and {c}; they must be from 1 to {MAX_FREQUENCY}, no two with a common divisor"
        )
    if not all(map(math.isfinite, phases)):
        raise CurveError(f"phases are {phases[0]} and {phases[1]}; they must be finite")
    t = 2 * np.pi * np.arange(count := _SAMPLES * max(frequencies)) / count
    curve = Curve(
        np.stack([np.cos(f * t + phase) for f, phase in zip(frequencies, (*phases, 0.0), strict=True)], axis=1)
    )
    if (gap := strand_gap(curve)) < least_gap:
        raise CurveError(f"strands of this Lissajous curve meet, or are only {gap:.1g} apart; change a phase a little")
    return inscribed(curve, vertices)


@checked
def overhand(vertices: int | None = None) -> Curve:
    """Make the overhand knot, a trefoil cut open, with straight ends and the given number of vertices, by default 120.

    It follows Shastri's polynomials (t³ − 3t, t⁴ − 4t², t⁵ − 10t), the last one scaled down.  Raises CurveError for
    fewer than 40 vertices, with which it might not be this knot.
    """
    count = 120 if vertices is None else vertices
    if count < _LEAST:
        raise CurveError(f"{count} vertices are too few for this arc; give {_LEAST} or more")
    t = np.linspace(-_REACH, _REACH, 2000)
    curve = np.stack([t**3 - 3.0 * t, t**4 - 4.0 * t**2, _FLATNESS * (t**5 - 10.0 * t)], axis=1)
    points = np.concatenate([[_end(curve[0], curve[1])], curve, [_end(curve[-1], curve[-2])]])
    return Curve(evenly(points, False, count), Mesh((count,), (False,)))


def _end(last: FloatArray, before: FloatArray) -> FloatArray:
    """The end of a segment that continues the tangent."""
    return np.asarray(last + _ENDS * (last - before) / np.linalg.norm(last - before))


ARCS: Mapping[str, Callable[[int | None], Curve]] = {"overhand": overhand}
"""Arcs with names."""
