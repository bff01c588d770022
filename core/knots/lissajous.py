"""Lissajous knots: three cosines."""

import math

import numpy as np

from ..arguments import checked
from ..curve import Curve
from ..errors import CurveError
from .inscribed import inscribed, strand_gap

MAX_FREQUENCY = 40
_SAMPLES = 160  # for each period of the fastest cosine
_NEAREST = 0.01  # gap between strands, of the half-width


@checked
def lissajous_knot(
    frequencies: tuple[int, int, int], phases: tuple[float, float] = (0.7, 0.2), vertices: int | None = None
) -> Curve:
    """Make the Lissajous knot (cos(a t + φ), cos(b t + ψ), cos(c t)), 0 ≤ t < 2π.

    Parameters
    ----------
    frequencies
        a, b and c: positive, no two of them with a common divisor.
    phases
        φ and ψ in radians.
    vertices
        Total number of vertices, by default enough.

    Raises
    ------
    CurveError
        If a number is not allowed, or the curve meets itself or nearly does.

    Examples
    --------
    >>> len(lissajous_knot((3, 2, 7), vertices=200))
    200
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
    if (gap := strand_gap(curve)) < _NEAREST:
        raise CurveError(f"strands of this Lissajous curve meet, or are only {gap:.1g} apart; change a phase a little")
    return inscribed(curve, vertices)
