"""Satellites of a knot: cables and Whitehead doubles, drawn within a tube around it."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..arguments import checked
from ..curve import Curve
from ..diagrams import linking_numbers
from ..errors import CurveError
from ..tube import normals, turned
from ..types import FloatArray
from .inscribed import arc_steps, inscribed

MAX_STRANDS, MAX_TURNS = 12, 100
_CLASP, _HOOK = 2.2, 0.8  # half the length of the clasp, and how far its hooks reach past each other, in radii
_TURN = 200  # points of each hook
_COARSE, _FINE = 400, 20_000  # samples that the reach is measured with, and at most of any tube
_SPACING = 0.1  # of the reach, between samples


@checked
def cable(companion: Curve, p: int, q: int, vertices: int | None = None, *, room: float = 0.5) -> Curve:
    """Make the cable C(p, q) of a knot: p strands along it that turn q/p times around, in gcd(p, q) components.

    Turns are counted from the longitude that does not link the knot, so that C(p, q) of the circle is T(p, q), and
    C(p, 0) are p parallel copies that do not link each other; negative q turn left.  The companion is a polygon that
    follows a smooth curve closely; ``room`` is the radius that the strands take, as a fraction of the thickest tube's.
    Raises CurveError if a number is not allowed, the companion is no knot, or the vertices are too few.
    """
    if not (2 <= p <= MAX_STRANDS and abs(q) <= MAX_TURNS):
        raise CurveError(
            f"a cable of {p} strands with {q} turns is of no use; strands are 2 to {MAX_STRANDS}, "
            f"turns -{MAX_TURNS} to {MAX_TURNS}"
        )
    tube, parts = Tube.around(companion), math.gcd(p, q)
    radius = tube.radius(room)
    turns = p // parts
    count = tube.samples(turns * tube.length + 2 * math.pi * radius * abs(q) / parts)
    t = turns * np.arange(count) / count
    angles = [2 * math.pi * (q * t + k) / p for k in range(parts)]
    return inscribed(
        Curve.from_components([tube.points(t, radius * np.cos(a), radius * np.sin(a)) for a in angles]), vertices
    )


@checked
def double(
    companion: Curve, twists: int = 0, *, clasp: int = 1, vertices: int | None = None, room: float = 0.5
) -> Curve:
    """Make a twisted Whitehead double of a knot: two strands along it that hook into each other at a clasp.

    Its Alexander polynomial is −cw t + (2 cw + 1) − cw t⁻¹ for w twists and a clasp c = ±1, whatever the companion.
    Twists are full, right-handed, and counted from the longitude that does not link the knot.  Otherwise as `cable`.
    """
    if abs(twists) > MAX_TURNS or clasp not in (1, -1):
        raise CurveError(
            f"twists is {twists} and clasp {clasp}; twists are -{MAX_TURNS} to {MAX_TURNS}, and a clasp 1 or -1"
        )
    tube = Tube.around(companion)
    radius = tube.radius(room)
    end, tip = _CLASP * radius / tube.length, _HOOK * radius / tube.length
    count = tube.samples(tube.length + 2 * math.pi * radius * abs(twists))
    share = np.linspace(0.0, 1.0, count, endpoint=False)
    # From the upright hook to the flat one the strands turn by a quarter more or less, which is the clasp's hand.
    turn = 2 * math.pi * twists + clasp * math.pi / 2
    there, back = math.pi / 2 + turn * share, 3 * math.pi / 2 + turn * (1 - share)
    tau = np.linspace(0.0, math.pi, _TURN, endpoint=False)
    level = np.zeros(_TURN)
    parts = (
        (end + (1 - 2 * end) * share, radius * np.cos(there), radius * np.sin(there)),
        (1 - end + (end + tip) * np.sin(tau), -clasp * radius * np.cos(tau), level),
        (1 - end - (1 - 2 * end) * share, radius * np.cos(back), radius * np.sin(back)),
        (end - (end + tip) * np.sin(tau), level, -radius * np.cos(tau)),
    )
    return inscribed(Curve(np.concatenate([tube.points(*part) for part in parts])), vertices)


@dataclass(frozen=True, eq=False)
class Tube:
    """A solid torus around a knot.

    Its points have coordinates t ∈ [0, 1) along the knot and (u, v) in the plane across it. Curves of constant (u, v)
    do not link the knot: they are its longitudes in the sense of Seifert.  ``length`` is the knot's, ``reach`` the
    radius of the thickest tube: discs across the knot do not meet within it.
    """

    length: float
    reach: float
    _frame: FloatArray  # center, and unit vectors across and up, at equal steps of t; shape (samples, 3, 3)

    @classmethod
    def around(cls, curve: Curve) -> "Tube":
        """The tube around the spline through the vertices of a knot; a CurveError for all but one closed component."""
        if curve.dimension != 3 or curve.mesh.closed != (True,):
            raise CurveError("satellites are drawn around a knot, one closed curve in space")
        closed = np.concatenate([curve.vertices, curve.vertices[:1]])
        spline = CubicSpline(np.append(arc_steps(curve.vertices), 1.0), closed, bc_type="periodic")
        reach = _reach(*_samples(spline, _COARSE))
        count = min(max(_COARSE, math.ceil(curve.length / (_SPACING * reach))), _FINE)
        center, tangent = _samples(spline, count)
        across = normals(center[None])[0]
        beside = Curve.from_components([center, center + 0.3 * reach * across])
        across = turned(across, tangent, -2.0 * np.pi * linking_numbers(beside)[0] * np.arange(count) / count)
        length = float(np.linalg.norm(np.diff(center, axis=0, append=center[:1]), axis=1).sum())
        return cls(length, reach, np.stack([center, across, np.cross(tangent, across)], axis=1))

    def radius(self, room: float) -> float:
        """The fraction ``room`` of the reach; a CurveError unless it is between 0 and 1."""
        if not 0.0 < room < 1.0:
            raise CurveError(f"room is {room}; it must be above 0 and below 1")
        return room * self.reach

    def samples(self, length: float) -> int:
        """Number of points that resolve a smooth curve of this length in the tube."""
        return max(400, math.ceil(length / (0.05 * self.reach)))

    def points(self, t: FloatArray, u: FloatArray, v: FloatArray) -> FloatArray:
        """Points in space, shape (k, 3), with these coordinates, each (k,); t is taken modulo 1."""
        place = t % 1.0 * len(self._frame)
        k = np.floor(place).astype(np.intp)
        here, there = (self._frame[each % len(self._frame)] for each in (k, k + 1))
        center, across, up = (here + (place % 1.0)[:, None, None] * (there - here)).swapaxes(0, 1)
        return np.asarray(center + u[:, None] * across + v[:, None] * up)


def _samples(spline: CubicSpline, count: int) -> tuple[FloatArray, FloatArray]:
    """Points and unit tangents at equal steps of the parameter, each (count, 3)."""
    t = np.arange(count) / count
    velocity = spline(t, 1)
    return spline(t), velocity / np.linalg.norm(velocity, axis=1)[:, None]


def _reach(points: FloatArray, tangents: FloatArray) -> float:
    """Radius of the smallest circle that is tangent to the curve at a point and passes through another (Federer)."""
    chord = points[:, None] - points[None]
    squared = (chord**2).sum(axis=2)
    height = np.linalg.norm(np.cross(chord, tangents[None]), axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.nanmin(squared / (2.0 * height)))
