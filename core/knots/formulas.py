"""Knots from formulas: Lissajous knots, arcs, a hard unknot; and cables and doubles, in a solid torus around a knot.

Knots as they are tied in ropes, loosely and with open ends, are splines through points of their drawings.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..base import CurveError, FloatArray, checked
from ..curve import Curve, Mesh, cubic_spline, evenly, nearest_strands
from ..curve.tube import normals, turned
from .diagrams import linking_numbers
from .inscribed import arc_steps, inscribed, shares


@checked
def lissajous_knot(
    frequencies: tuple[int, int, int], phases: tuple[float, float] = (0.7, 0.2), vertices: int | None = None
) -> Curve:
    """Make the Lissajous knot (cos(a t + φ), cos(b t + ψ), cos(c t)), 0 ≤ t < 2π.

    Frequencies are positive, no two with a common divisor; phases are in radians.  Raises CurveError for others, and
    for strands nearer than 0.01, as default polygons would have thousands of vertices.
    """
    a, b, c = frequencies
    # beyond 40, strands are too near to each other to be of any use
    if not all(1 <= f <= 40 for f in frequencies) or max(math.gcd(a, b), math.gcd(b, c), math.gcd(a, c)) > 1:
        raise CurveError(f"frequencies are {a}, {b} and {c}; they must be from 1 to 40, no two with a common divisor")
    if not all(map(math.isfinite, phases)):
        raise CurveError(f"phases are {phases[0]} and {phases[1]}; they must be finite")
    t = 2 * np.pi * np.arange(count := 160 * max(frequencies)) / count  # in each period of the fastest cosine 160
    waves = [np.cos(f * t + phase) for f, phase in zip(frequencies, (*phases, 0.0), strict=True)]
    curve = Curve(np.stack(waves, axis=1))
    if (gap := nearest_strands(curve, 2.0)) < 0.01:
        raise CurveError(f"strands of this Lissajous curve meet, or are only {gap:.1g} apart; change a phase a little")
    return inscribed(curve, vertices)


@checked
def overhand(vertices: int | None = None) -> Curve:
    """Make the overhand knot, a trefoil cut open, with straight ends and the given number of vertices, by default 120.

    It follows Shastri's polynomials (t³ − 3t, t⁴ − 4t², t⁵ − 10t), the last one scaled down.  Raises CurveError for
    fewer than 40 vertices, with which it might not be this knot.
    """
    count = 120 if vertices is None else vertices
    if count < 40:
        raise CurveError(f"{count} vertices are too few for this arc; give 40 or more")
    t = np.linspace(-2.1, 2.1, 2000)  # beyond, the curve is all but straight
    curve = np.stack([t**3 - 3.0 * t, t**4 - 4.0 * t**2, 0.1 * (t**5 - 10.0 * t)], axis=1)
    # segments of length 3 continue the tangents
    ends = [a + 3.0 * (a - b) / np.linalg.norm(a - b) for a, b in (curve[:2], curve[:-3:-1])]
    return Curve(evenly(np.concatenate([ends[:1], curve, ends[1:]]), False, count), Mesh((count,), (False,)))


@checked
def freedman(vertices: int | None = None) -> Curve:
    """Make an unknot like Freedman's, from which Figures 1 to 3 of [RS21] start; by default it has 579 vertices.

    It is the rim of a ribbon with an overhand knot near each end, one of which is the mirror image of the other:
    shortened from its ends, the ribbon comes out of both.  (M. Freedman, Z.-X. He and Z. Wang, *Möbius energy of knots
    and unknots*, Annals of Mathematics 139, 1994.)  Raises CurveError if the vertices are too few.
    """
    t = np.linspace(0.5 - math.pi, math.pi - 0.5, 40)  # of a trefoil that is cut open where it is outermost
    trefoil = np.stack([np.sin(t) + 2.0 * np.sin(2.0 * t), np.cos(t) - 2.0 * np.cos(2.0 * t), -np.sin(3.0 * t)], axis=1)
    half = np.concatenate([[[1.2, -6.0, 0.0], [1.2, -4.5, 0.0]], trefoil, [[-2.0, -4.3, 0.0]]])
    half[:, 0] += 5.5
    spline = cubic_spline(np.concatenate([half, half[::-1] * [-1.0, 1.0, 1.0]]), closed=False)
    at = np.linspace(0.0, spline.x[-1], 3000)
    middle, along = spline(at), spline(at, 1)
    along /= np.linalg.norm(along, axis=1)[:, None]
    across = np.cross([0.0, 0.0, 1.0], along)
    across *= 0.25 / np.linalg.norm(across, axis=1)[:, None]
    turn = np.linspace(0.0, math.pi, 60)[1:-1, None]
    last, first = (
        middle[k] + side * (np.cos(turn) * across[k] + 0.25 * np.sin(turn) * along[k])
        for k, side in ((-1, 1.0), (0, -1.0))
    )
    return inscribed(Curve(np.concatenate([middle + across, last, (middle - across)[::-1], first])), vertices)


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


FORMULAS: Mapping[str, Callable[[int | None], Curve]] = {"overhand": overhand, "freedman": freedman, **ROPES}
"""Curves from formulas and splines that have names."""


MAX_STRANDS, MAX_TURNS = 12, 100


@checked
def cable(companion: Curve, p: int, q: int, vertices: int | None = None) -> Curve:
    """Make the cable C(p, q) of a knot: p strands along it that turn q/p times around, in gcd(p, q) components.

    Turns are counted from the longitude that does not link the knot, so that C(p, q) of the circle is T(p, q), and
    C(p, 0) are p parallel copies that do not link each other; negative q turn left.  The companion is a polygon that
    follows a smooth curve closely; strands take half the radius of the thickest tube around it.  Raises CurveError if a
    number is not allowed, the companion is no knot, or the vertices are too few.
    """
    if not (2 <= p <= MAX_STRANDS and abs(q) <= MAX_TURNS):
        allowed = f"strands are 2 to {MAX_STRANDS}, turns -{MAX_TURNS} to {MAX_TURNS}"
        raise CurveError(f"a cable of {p} strands with {q} turns is of no use; {allowed}")
    tube, parts = SolidTorus.around(companion), math.gcd(p, q)
    radius, turns = 0.5 * tube.reach, p // parts
    count = tube.samples(turns * tube.length + 2 * math.pi * radius * abs(q) / parts)
    t = turns * np.arange(count) / count
    angles = [2 * math.pi * (q * t + k) / p for k in range(parts)]
    strands = [tube.points(t, radius * np.cos(a), radius * np.sin(a)) for a in angles]
    return inscribed(Curve.from_components(strands), vertices)


@checked
def double(companion: Curve, twists: int = 0, *, clasp: int = 1, vertices: int | None = None) -> Curve:
    """Make a twisted Whitehead double of a knot: two strands along it that hook into each other at a clasp.

    Its Alexander polynomial is −cw t + (2 cw + 1) − cw t⁻¹ for w twists and a clasp c = ±1, whatever the companion.
    Twists are full, right-handed, and counted from the longitude that does not link the knot.  Otherwise as `cable`.
    """
    if abs(twists) > MAX_TURNS or clasp not in (1, -1):
        allowed = f"twists are -{MAX_TURNS} to {MAX_TURNS}, and a clasp 1 or -1"
        raise CurveError(f"twists is {twists} and clasp {clasp}; {allowed}")
    tube = SolidTorus.around(companion)
    radius = 0.5 * tube.reach
    # half the length of the clasp, and how far its hooks reach past each other
    end, tip = 2.2 * radius / tube.length, 0.8 * radius / tube.length
    count = tube.samples(tube.length + 2 * math.pi * radius * abs(twists))
    share = np.linspace(0.0, 1.0, count, endpoint=False)
    # From the upright hook to the flat one the strands turn by a quarter more or less, which is the clasp's hand.
    turn = 2 * math.pi * twists + clasp * math.pi / 2
    there, back = math.pi / 2 + turn * share, 3 * math.pi / 2 + turn * (1 - share)
    tau = np.linspace(0.0, math.pi, 200, endpoint=False)
    level = np.zeros(200)
    parts = (
        (end + (1 - 2 * end) * share, radius * np.cos(there), radius * np.sin(there)),
        (1 - end + (end + tip) * np.sin(tau), -clasp * radius * np.cos(tau), level),
        (1 - end - (1 - 2 * end) * share, radius * np.cos(back), radius * np.sin(back)),
        (end - (end + tip) * np.sin(tau), level, -radius * np.cos(tau)),
    )
    return inscribed(Curve(np.concatenate([tube.points(*part) for part in parts])), vertices)


@dataclass(frozen=True, eq=False)
class SolidTorus:
    """A solid torus around a knot.

    Its points have coordinates t ∈ [0, 1) along the knot and (u, v) in the plane across it. Curves of constant (u, v)
    do not link the knot: they are its longitudes in the sense of Seifert.  ``length`` is the knot's, ``reach`` the
    radius of the thickest tube: discs across the knot do not meet within it.
    """

    length: float
    reach: float
    _frame: FloatArray  # center, and unit vectors across and up, at equal steps of t; shape (samples, 3, 3)

    @classmethod
    def around(cls, curve: Curve) -> "SolidTorus":
        """The tube around the spline through the vertices of a knot; a CurveError for all but one closed component."""
        from scipy.interpolate import CubicSpline  # which takes a while to import

        if curve.dimension != 3 or curve.mesh.closed != (True,):
            raise CurveError("satellites are drawn around a knot, one closed curve in space")
        closed = np.concatenate([curve.vertices, curve.vertices[:1]])
        spline = CubicSpline(np.append(arc_steps(curve.vertices), 1.0), closed, bc_type="periodic")

        def sample(count: int) -> tuple[FloatArray, FloatArray]:
            """Points and unit tangents at equal steps of the parameter, each (count, 3)."""
            t = np.arange(count) / count
            velocity = spline(t, 1)
            return spline(t), velocity / np.linalg.norm(velocity, axis=1)[:, None]

        # radius of the smallest circle that is tangent to the curve at a point and passes through another (Federer)
        center, tangent = sample(400)
        chord = center[:, None] - center[None]
        height = np.linalg.norm(np.cross(chord, tangent[None]), axis=2)
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = float(np.nanmin((chord**2).sum(axis=2) / (2.0 * height)))
        center, tangent = sample(min(max(400, math.ceil(curve.length / (0.1 * reach))), 20_000))
        count = len(center)
        across = normals(center[None])[0]
        beside = Curve.from_components([center, center + 0.3 * reach * across])
        across = turned(across, tangent, -2.0 * np.pi * linking_numbers(beside)[0] * np.arange(count) / count)
        length = float(np.linalg.norm(np.diff(center, axis=0, append=center[:1]), axis=1).sum())
        return cls(length, reach, np.stack([center, across, np.cross(tangent, across)], axis=1))

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
