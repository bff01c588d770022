"""Braid words, diagrams of their closures, and smooth closed braids around the z axis, torus knots among them.

A word is a tuple of signed letters; letter i is the crossing σ_i of strands i and i+1, −i its inverse.  A positive
letter is a positive (right-handed) crossing, so the closure of (1, 1, 1) is the right-handed trefoil.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..base import CurveError, FloatArray, IntArray, checked
from ..curve import Curve, arc_lengths
from .diagrams import Diagram, Pass, diagram_of
from .inscribed import MAX_VERTICES, check_count, shares, too_few

Word = tuple[int, ...]


def checked_word(word: Sequence[int], strands: int | None = None) -> tuple[Word, int]:
    """A word and its number of strands, the least by default; CurveError if letters are 0 or strands do not fit."""
    letters = tuple(word)
    for position, letter in enumerate(letters, start=1):
        if int(letter) != letter or letter == 0:
            raise CurveError(f"letter {position} of the braid word is {letter!r}; letters are whole numbers, not 0")
    letters = tuple(map(int, letters))
    needed = max(map(abs, letters), default=0) + 1
    strands = needed if strands is None else strands
    if strands < needed:
        raise CurveError(f"the braid has {strands} strands, but its letters need {needed}")
    if strands > 500 or len(letters) > 20_000:
        told = f"the braid has {strands} strands and {len(letters)} letters"
        raise CurveError(f"{told}; at most 500 and 20000 are allowed")
    return letters, strands


def cycles(word: Sequence[int], strands: int) -> list[list[int]]:
    """For each component of the closure the places, from 0, where its turns begin; each starts with its smallest."""
    at = list(range(strands))
    for letter in word:
        i = abs(letter) - 1
        at[i], at[i + 1] = at[i + 1], at[i]
    ends = {strand: place for place, strand in enumerate(at)}
    found: list[list[int]] = []
    for place in range(strands):
        cycle = []
        while place in ends:
            cycle.append(place)
            place = ends.pop(place)
        found += [cycle] if cycle else []
    return found


def columns(word: Sequence[int]) -> tuple[list[int], int]:
    """The first column where each letter's strands are free, as letters that share none commute; how many columns."""
    free: dict[int, int] = {}
    places = []
    for letter in word:
        i = abs(letter)
        place = max(free.get(i, 0), free.get(i + 1, 0))
        free[i] = free[i + 1] = place + 1
        places.append(place)
    return places, max(free.values(), default=0)


def mirror(word: Sequence[int]) -> Word:
    return tuple(-letter for letter in word)


def connected_sum(first: Sequence[int], second: Sequence[int]) -> Word:
    """Word whose closure is the connected sum, the second braid attached to the first one's last strand."""
    shift = max(map(abs, first), default=0)
    return (*first, *(letter + shift if letter > 0 else letter - shift for letter in second))


def braid_diagram(word: Sequence[int]) -> Diagram:
    """The closure of a braid as the word draws it; raises as `checked_word` does."""
    letters, strands = checked_word(word)
    passes: list[list[Pass]] = [[] for _ in range(strands)]
    at = list(range(strands))
    for crossing, letter in enumerate(letters):
        place = abs(letter) - 1
        passes[at[place]].append((crossing, letter > 0))  # in a positive crossing the one that moves outwards is over
        passes[at[place + 1]].append((crossing, letter < 0))
        at[place], at[place + 1] = at[place + 1], at[place]
    parts = (tuple(each for strand in cycle for each in passes[strand]) for cycle in cycles(letters, strands))
    return Diagram(tuple(parts), tuple(1 if letter > 0 else -1 for letter in letters))


def plat_diagram(word: Sequence[int]) -> Diagram:
    """The plat of a braid: its strands, an even number, are joined in pairs at either end; raises as `checked_word`.

    With three strands' letters these are the two-bridge links (Birman 1976).
    """
    letters, strands = checked_word(word)
    ends = [place // 2 for place in range(strands + strands % 2)]  # the edge that comes up at each place
    new, circles = len(ends) // 2, 0
    code: list[tuple[int, ...]] = []
    for letter in letters:
        i = abs(letter) - 1
        left, right = ends[i : i + 2]
        code.append((right, new + 1, new, left) if letter > 0 else (left, right, new + 1, new))
        ends[i : i + 2] = new, new + 1
        new += 2
    for place in range(0, len(ends), 2):
        kept, other = ends[place : place + 2]
        circles += kept == other
        code = [tuple(kept if edge == other else edge for edge in edges) for edges in code]
        ends = [kept if edge == other else edge for edge in ends]
    diagram = diagram_of(code)
    return Diagram((*diagram.passes, *((),) * circles), diagram.signs)


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
    detail = max(60, 2 * count * width)
    check_count(detail)  # before strands are followed through so many columns
    inner = max(2.2 * width / (2 * math.pi), 1.0)  # a crossing is 2.2 long there, in units of the strands' distance
    scale = 1.0 / (inner + (count - 1) / 2)
    moves: dict[tuple[int, int], tuple[int, int]] = {}  # by column and place before it: where to, and the sign
    for letter, column in zip(letters, places, strict=True):
        i, sign = abs(letter) - 1, 1 if letter > 0 else -1
        moves[column, i], moves[column, i + 1] = (1, sign), (-1, sign)

    def profile(track: IntArray, theta: FloatArray) -> FloatArray:
        """Distance from the axis and height of one component at angles (k,); shape (k, 2)."""
        along = np.asarray(theta, dtype=np.float64) / (2 * math.pi) * max(width, 1)
        # The clip keeps the closing angle 2π·turns in the last column instead of past it.
        column = np.clip(np.floor(along).astype(np.intp), 0, track.shape[1] - 1)
        place, move, sign = track[:, column]
        x = along - column
        angle = math.pi * (x * x * (3.0 - 2.0 * x))
        radius = inner + place + 0.5 * move * (1 - np.cos(angle))
        # The strand moving outwards passes over in a positive crossing and under in a negative one.
        return np.stack([scale * radius, scale * 0.5 * move * sign * np.sin(angle)], axis=1)

    rings = []
    for cycle in cycles(letters, count):
        # for every column, turn after turn: the place before it, the move, and the crossing's sign
        rows = []
        for place in cycle:
            for column in range(max(width, 1)):
                move, sign = moves.get((column, place), (0, 0))
                rows.append((place, move, sign))
                place += move
        rings.append(Ring(len(cycle), partial(profile, np.array(rows, dtype=np.intp).T)))
    return _polygon(rings, scale, detail, vertices)


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
    if not (0 < abs(p) <= 2000 and 0 < abs(q) <= 2000):
        raise CurveError(f"T({p},{q}) cannot be made; |p| and |q| must be from 1 to 2000")
    hand = 1 if p * q > 0 else -1
    p, q = abs(p), abs(q)
    minor = major * min(p / math.hypot(p, 1.25 * q), 0.6) if minor is None else minor
    if not 1e-100 < minor < major < 1e100:  # whose squares are still doubles
        raise CurveError(f"major is {major} and minor {minor}; they must satisfy 0 < minor < major, not beyond 1e±100")
    parts = math.gcd(p, q)

    def section(phi: FloatArray) -> FloatArray:
        """Points of the tube's cross-section at conformal angles (k,), counted from the outside; shape (k, 2)."""
        r2 = minor / major
        stretch = major * (1 - r2**2) / (1 - r2 * np.cos(phi))
        return np.stack([stretch, stretch * r2 * np.sin(phi) / math.sqrt(1 - r2**2)], axis=1)

    def profile(phase: float, theta: FloatArray) -> FloatArray:
        # turning from outwards to upwards while going round is a left-handed screw
        return section(q / p * theta + phase) * [1, -hand]

    rings = [Ring(p // parts, partial(profile, 2 * math.pi * k / p)) for k in range(parts)]
    gap = minor  # one strand never meets itself within a half plane; this only sets the number of vertices
    if p > 1:
        phases = np.linspace(0.0, 2 * math.pi / p, 64)[:, None] + 2 * math.pi / p * np.arange(p)
        points = section(phases.ravel()).reshape(64, p, 2)
        gap = float(np.linalg.norm(points - np.roll(points, 1, axis=1), axis=2).min())
    return _polygon(rings, gap, max(60, 16 * max(p, q)), vertices)


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
        # edges of 0.7 gaps: tilted strands are a little nearer than the gap
        vertices = min(max(math.ceil(lengths.sum() / (0.7 * gap)), detail), MAX_VERTICES)
    curves = []
    for ring, count in zip(rings, shares(vertices, lengths), strict=True):
        ends = np.linspace(0.0, ring.period, count + 1)
        for _ in range(20):  # to nearly equal edges
            along = arc_lengths(ring.points(ends))
            ends = np.interp(np.linspace(0.0, along[-1], count + 1), along, ends)
        points, steps = ring.points(ends), np.diff(ends)
        if steps.min() <= 0 or steps.max() > 0.9 * math.pi:  # an edge goes backwards or too far
            raise too_few(vertices)
        # Where the distance between polygon and curve within a half plane stays below half the gap, moving every point
        # straight from one to the other lets no two strands meet: polygon and curve are the same closed braid.
        pages = ends[:-1, None] + steps[:, None] * np.arange(1, 8) / 8  # each edge is compared in so many half planes
        tails, edges = points[:-1, None], np.diff(points, axis=0)[:, None]
        normal = np.stack([-np.sin(pages), np.cos(pages), np.zeros_like(pages)], axis=2)
        s = -(tails * normal).sum(axis=2) / (edges * normal).sum(axis=2)
        hits = tails + s[:, :, None] * edges
        within = np.stack([np.hypot(hits[:, :, 0], hits[:, :, 1]), hits[:, :, 2]], axis=2)
        if np.linalg.norm(within - ring.at(pages.ravel()).reshape(within.shape), axis=2).max() >= gap / 2:
            raise too_few(vertices)
        curves.append(points[:-1])
    return Curve.from_components(curves)
