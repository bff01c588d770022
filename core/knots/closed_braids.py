"""Smooth closed braids around the z axis, torus knots among them, and polygons checked to be the same braids."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arguments import checked
from ..curve import Curve
from ..curve.smooth import arc_lengths
from ..errors import CurveError
from ..types import FloatArray, IntArray
from .braids import checked_word, columns, cycles
from .inscribed import MAX_VERTICES, check_count, shares, too_few

_COLUMN = 2.2  # length of a crossing along the innermost strand, in units of the strands' distance
_EDGE = 0.7  # default edge length in units of the gap; tilted strands are a little nearer than the gap
_PAGES_PER_EDGE = 8  # half planes in which each edge is compared with the curve
_MAX_TURNS = 2000  # of torus knots: beyond all use
_MAX_RADIUS = 1e100  # whose square is still a double


@checked
def braid_closure(word: Sequence[int], vertices: int | None = None, *, strands: int | None = None) -> Curve:
    """Make the closure of a braid, one component per cycle of its permutation.

    The strands are concentric circles around the z axis, unit distance apart before the whole is scaled to a
    middle radius of 1; every crossing is a smooth half twist of two neighbours.  Seen from above the curve is the usual
    picture of the closed braid.

    ``word`` has letters ±i, see :mod:`mobius_flow.core.knots.braids`, and is empty for the trivial braid; there are as
    few strands and as many vertices as needed, unless given.  Raises CurveError if it is no braid word or the vertices
    are too few.

    >>> len(braid_closure([1, 1]).mesh.component_sizes)
    2
    """
    letters, count = checked_word(word, strands)
    places, width = columns(letters)
    inner = max(_COLUMN * width / (2 * math.pi), 1.0)
    scale = 1.0 / (inner + (count - 1) / 2)
    moves: dict[tuple[int, int], tuple[int, int]] = {}  # by column and place before it: where to, and the sign
    for letter, column in zip(letters, places, strict=True):
        i, sign = abs(letter) - 1, 1 if letter > 0 else -1
        moves[column, i], moves[column, i + 1] = (1, sign), (-1, sign)
    rings = []
    for cycle in cycles(letters, count):
        track = _track(cycle, moves, max(width, 1))
        rings.append(Ring(len(cycle), partial(_braid_profile, track, max(width, 1), inner, scale)))
    return _polygon(rings, scale, max(60, 2 * count * width), vertices)


@checked
def torus_knot(p: int, q: int, vertices: int | None = None, *, major: float = 1.0, minor: float | None = None) -> Curve:
    """Make the torus knot T(p, q), or the torus link of gcd(p, q) components.

    It is the stereographic image of (r₁ e^{ipt}, r₂ e^{iqt}) on a flat torus r₁² + r₂² = 1 of the 3-sphere, with
    r₂ = ``minor / major``: it runs p times around the z axis and q times around the tube, its strands evenly spread in
    the conformal sense. Positive p and q give the right-handed knot, a negative one its mirror image.

    ``vertices`` is the total number; by default edges are shorter than strands are apart.  The radii of the torus and
    of its tube satisfy 0 < minor < major; the default tube is near the one of least Möbius energy, which for T(2, 3) is
    0.47407312473.  Raises CurveError if a number is not allowed, or the vertices are too few.
    """
    if not (0 < abs(p) <= _MAX_TURNS and 0 < abs(q) <= _MAX_TURNS):
        raise CurveError(f"T({p},{q}) cannot be made; |p| and |q| must be from 1 to {_MAX_TURNS}")
    hand = 1 if p * q > 0 else -1
    p, q = abs(p), abs(q)
    minor = major * min(p / math.hypot(p, 1.25 * q), 0.6) if minor is None else minor
    if not 1 / _MAX_RADIUS < minor < major < _MAX_RADIUS:
        raise CurveError(f"major is {major} and minor {minor}; they must satisfy 0 < minor < major, not beyond 1e±100")
    parts = math.gcd(p, q)
    profile = partial(_torus_profile, major, minor, hand, q / p)
    rings = [Ring(p // parts, partial(profile, 2 * math.pi * k / p)) for k in range(parts)]
    return _polygon(rings, _torus_gap(p, major, minor), max(60, 16 * max(p, q)), vertices)


@dataclass(frozen=True)
class Ring:
    """A smooth closed curve that runs ``turns`` times around the z axis."""

    turns: int
    at: Callable[[FloatArray], FloatArray]  # distance from the axis and height, (k, 2), at angles (k,) up to the period

    @property
    def period(self) -> float:
        return 2 * math.pi * self.turns

    def points(self, theta: FloatArray) -> FloatArray:
        """Points in space at angles of shape (k,); shape (k, 3)."""
        rho, z = self.at(theta).T
        return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)


def _polygon(rings: Sequence[Ring], gap: float, detail: int, vertices: int | None) -> Curve:
    """Inscribe a polygon with nearly equal edges in rings that do not meet.

    ``gap`` is the least distance between two strands within a half plane that ends at the axis; by default there are so
    many vertices that edges are shorter than that, and at least ``detail``.
    """
    check_count(max(detail, vertices or 0))
    around = [ring.points(np.linspace(0.0, ring.period, 8 * detail + 1)) for ring in rings]
    lengths = np.array([float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) for points in around])
    if vertices is None:
        vertices = min(max(math.ceil(lengths.sum() / (_EDGE * gap)), detail), MAX_VERTICES)
    angles = [_equal_edges(ring, count) for ring, count in zip(rings, shares(vertices, lengths), strict=True)]
    if any(_deviation(ring, theta) >= gap / 2 for ring, theta in zip(rings, angles, strict=True)):
        raise too_few(vertices)
    return Curve.from_components([ring.points(theta) for ring, theta in zip(rings, angles, strict=True)])


def _equal_edges(ring: Ring, count: int) -> FloatArray:
    """Angles, from 0 on, at which an inscribed polygon has nearly equal edges; shape (count,)."""
    theta = np.linspace(0.0, ring.period, count + 1)
    for _ in range(20):
        along = arc_lengths(ring.points(theta))
        theta = np.interp(np.linspace(0.0, along[-1], count + 1), along, theta)
    return theta[:-1]


def _deviation(ring: Ring, theta: FloatArray) -> float:
    """Largest distance between polygon and curve within a half plane; infinite if an edge goes backwards or too far.

    Where this stays below half the gap, moving every point straight from the curve to the polygon within its
    half plane lets no two strands meet: polygon and curve are the same closed braid.
    """
    ends = np.append(theta, ring.period)
    steps = np.diff(ends)
    if steps.min() <= 0 or steps.max() > 0.9 * math.pi:
        return math.inf
    fractions = np.arange(1, _PAGES_PER_EDGE) / _PAGES_PER_EDGE
    pages = theta[:, None] + steps[:, None] * fractions
    points = ring.points(ends)
    tails, edges = points[:-1, None], np.diff(points, axis=0)[:, None]
    normal = np.stack([-np.sin(pages), np.cos(pages), np.zeros_like(pages)], axis=2)
    s = -(tails * normal).sum(axis=2) / (edges * normal).sum(axis=2)
    hits = tails + s[:, :, None] * edges
    within = np.stack([np.hypot(hits[:, :, 0], hits[:, :, 1]), hits[:, :, 2]], axis=2)
    smooth = ring.at(pages.ravel()).reshape(within.shape)
    return float(np.linalg.norm(within - smooth, axis=2).max())


def _track(cycle: Sequence[int], moves: dict[tuple[int, int], tuple[int, int]], width: int) -> IntArray:
    """For every column, turn after turn, a component's place before it, its move, and its crossing's sign."""
    track = []
    for place in cycle:
        for column in range(width):
            move, sign = moves.get((column, place), (0, 0))
            track.append((place, move, sign))
            place += move
    return np.array(track, dtype=np.intp).T


def _braid_profile(track: IntArray, width: int, inner: float, scale: float, theta: FloatArray) -> FloatArray:
    """Distance from the axis and height of one component at angles (k,); shape (k, 2)."""
    along = np.asarray(theta, dtype=np.float64) / (2 * math.pi) * width
    # The clip keeps the closing angle 2π·turns in the last column instead of past it.
    column = np.clip(np.floor(along).astype(np.intp), 0, track.shape[1] - 1)
    place, move, sign = track[:, column]
    x = along - column
    angle = math.pi * (x * x * (3.0 - 2.0 * x))
    radius = inner + place + 0.5 * move * (1 - np.cos(angle))
    # The strand moving outwards passes over in a positive crossing and under in a negative one.
    height = 0.5 * move * sign * np.sin(angle)
    return np.stack([scale * radius, scale * height], axis=1)


def _torus_profile(major: float, minor: float, hand: int, slope: float, phase: float, theta: FloatArray) -> FloatArray:
    """Distance from the axis and height at angles (k,) around the axis; shape (k, 2)."""
    # Turning from outwards to upwards while going round is a left-handed screw.
    return _tube(major, minor, slope * theta + phase) * [1, -hand]


def _tube(major: float, minor: float, phi: FloatArray) -> FloatArray:
    """Points of the tube's cross-section at conformal angles (k,), counted from the outside; shape (k, 2)."""
    r2 = minor / major
    stretch = major * (1 - r2**2) / (1 - r2 * np.cos(phi))
    return np.stack([stretch, stretch * r2 * np.sin(phi) / math.sqrt(1 - r2**2)], axis=1)


def _torus_gap(p: int, major: float, minor: float) -> float:
    """Least distance between two of the p strands within a half plane, over all half planes."""
    if p == 1:
        return minor  # one strand never meets itself there; this only sets the number of vertices
    phases = np.linspace(0.0, 2 * math.pi / p, 64)[:, None] + 2 * math.pi / p * np.arange(p)
    points = _tube(major, minor, phases.ravel()).reshape(64, p, 2)
    return float(np.linalg.norm(points - np.roll(points, 1, axis=1), axis=2).min())
