"""Satellites of a knot: cables and Whitehead doubles, drawn within a tube around it."""

import math

import numpy as np

from ..arguments import checked
from ..curve import Curve
from ..errors import CurveError
from ..types import FloatArray
from .inscribed import inscribed
from .tubes import Tube

MAX_STRANDS, MAX_TURNS = 12, 100
_ROOM = 0.5  # radius that the pattern takes, of the tube's
_CLASP, _HOOK = 2.2, 0.8  # half the length of the clasp, and how far its hooks reach past each other, in those radii
_TURN = 200  # points of each hook


@checked
def cable(companion: Curve, p: int, q: int, vertices: int | None = None) -> Curve:
    """Make the cable C(p, q) of a knot: p strands along it that turn q/p times around, in gcd(p, q) components.

    Turns are counted from the longitude that does not link the knot, so that C(p, q) of the circle is T(p, q), and
    C(p, 0) are p parallel copies that do not link each other.

    Parameters
    ----------
    companion
        The knot, a polygon that follows a smooth curve closely.
    p, q
        Number of strands, 2 or more, and of turns; negative q turn left.
    vertices
        Total number of vertices, by default enough.

    Raises
    ------
    CurveError
        If a number is not allowed, the companion is no knot, or the vertices are too few.
    """
    if not (2 <= p <= MAX_STRANDS and abs(q) <= MAX_TURNS):
        raise CurveError(
            f"a cable of {p} strands with {q} turns is of no use; strands are 2 to {MAX_STRANDS}, "
            f"turns -{MAX_TURNS} to {MAX_TURNS}"
        )
    tube, parts = Tube.around(companion), math.gcd(p, q)
    radius = _ROOM * tube.reach
    turns = p // parts
    count = _samples(tube, turns * tube.length + 2 * math.pi * radius * abs(q) / parts)
    t = turns * np.arange(count) / count
    angles = [2 * math.pi * (q * t + k) / p for k in range(parts)]
    return inscribed(
        Curve.from_components([tube.points(t, radius * np.cos(a), radius * np.sin(a)) for a in angles]), vertices
    )


@checked
def double(companion: Curve, twists: int = 0, *, clasp: int = 1, vertices: int | None = None) -> Curve:
    """Make a twisted Whitehead double of a knot: two strands along it that hook into each other at a clasp.

    Its Alexander polynomial is −cw t + (2 cw + 1) − cw t⁻¹ for w twists and a clasp c, whatever the companion.

    Parameters
    ----------
    companion
        The knot, a polygon that follows a smooth curve closely.
    twists
        Number of full right-handed twists of the strands around each other, counted from the longitude that does not
        link the knot.
    clasp
        1 or −1: handedness of the clasp.
    vertices
        Total number of vertices, by default enough.

    Raises
    ------
    CurveError
        If a number is not allowed, the companion is no knot, or the vertices are too few.
    """
    if abs(twists) > MAX_TURNS or clasp not in (1, -1):
        raise CurveError(
            f"twists is {twists} and clasp {clasp}; twists are -{MAX_TURNS} to {MAX_TURNS}, and a clasp 1 or -1"
        )
    tube = Tube.around(companion)
    radius = _ROOM * tube.reach
    end, tip = _CLASP * radius / tube.length, _HOOK * radius / tube.length
    share = np.linspace(0.0, 1.0, _samples(tube, tube.length + 2 * math.pi * radius * abs(twists)), endpoint=False)
    # From the upright hook to the flat one the strands turn by a quarter more or less, which is the clasp's hand.
    turn = 2 * math.pi * twists + clasp * math.pi / 2
    there = _strand(end + (1 - 2 * end) * share, math.pi / 2 + turn * share, radius)
    back = _strand(1 - end - (1 - 2 * end) * share, 3 * math.pi / 2 + turn * (1 - share), radius)
    tau = np.linspace(0.0, math.pi, _TURN, endpoint=False)
    flat = 1 - end + (end + tip) * np.sin(tau), -clasp * radius * np.cos(tau), np.zeros(_TURN)
    upright = end - (end + tip) * np.sin(tau), np.zeros(_TURN), -radius * np.cos(tau)
    return inscribed(Curve(np.concatenate([tube.points(*part) for part in (there, flat, back, upright)])), vertices)


def _strand(t: FloatArray, angle: FloatArray, radius: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    return t, radius * np.cos(angle), radius * np.sin(angle)


def _samples(tube: Tube, length: float) -> int:
    """Number of points that stand for a smooth curve of this length in a tube."""
    return max(400, math.ceil(length / (0.05 * tube.reach)))
