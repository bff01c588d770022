"""Check recorded motions of curves by whole numbers alone: ``python checker.py T.npz ...``.

What a file must fulfil, and why that is enough, is in docs/certificate.md.  Exit status: 0 accepted, 1 rejected.  This
file needs Python's standard library only, and shares no line with the program that finds motions.  Doubles are whole
numbers in a unit that is a power of two, and nothing is rounded.  Of two edges

1. boxes, or planes that stand still for a part of the time, may show that they are apart (``mobius-flow verify`` asks
   a floating-point filter with error bounds instead);
2. else they can meet where the volume of the four ends, a cubic polynomial in time, is zero: at its roots, isolated by
   Descartes' rule, signs of quadratic polynomials tell whether they do;
3. if it is zero all the time, meeting is a matter of signs of finitely many polynomials, the same between neighbouring
   roots of these; as the times of contact are a closed set, a root or an end of the leg is one, or none is.
"""

import ast
import math
import struct
import sys
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import chain, combinations, pairwise, product
from operator import mul
from os import PathLike, stat
from typing import Any

Path = str | PathLike[str]
Polynomial = list[int]
Time = tuple[Polynomial, int, int, int]  # as `roots` gives it
Vector = Sequence[int]
Motion = Sequence[Vector]  # a point's places at the times 0 and 1
Coordinates = tuple[float | Fraction, ...]  # exact: a double, or a fraction whose denominator is a power of two
Points = Sequence[Coordinates]
Box = tuple[Coordinates, Coordinates]
Rows = Iterator[tuple[Any, ...]]

FLOATS, FLAGS, WHOLE = {"<f8": "<d"}, {"|b1": "<?"}, {"|i1": "<b", "|u1": "<B"}  # types, with codes for struct
SIZES = ("i2", "h"), ("u2", "H"), ("i4", "i"), ("u4", "I"), ("i8", "q"), ("u8", "Q")
WHOLE |= {f"{order}{kind}": f"{order}{code}" for order in "<>" for kind, code in SIZES}


class TrajectoryError(ValueError):
    """A file that is not a trajectory; the message says why."""


class RefusedError(Exception):
    """What a trajectory states is not so, or cannot be decided; the message says why."""

    def __init__(self, message: str, edges: tuple[int, ...] | None = None, obstacle: int | None = None) -> None:
        super().__init__(message)
        self.edges, self.obstacle = edges, obstacle


@dataclass(frozen=True)
class Verdict:
    """The findings; numbers of what failed count from 0, and are None if that is not the reason."""

    accepted: bool  #: whether every leg and every change of stage is proved free of contact
    stages: int  #: how many were checked, including the one that failed
    legs: int
    reason: str = ""  #: why the trajectory is not accepted; empty if it is
    stage: int | None = None  #: the stage of the failure
    frame: int | None = None  #: the frame with which the failed leg begins
    edges: tuple[int, ...] | None = None  #: the edges that meet, or the one that meets an obstacle
    obstacles: int = 0  #: how many there are
    obstacle: int | None = None  #: the one that an edge meets
    pins: int = 0  #: how many vertices are held, in every frame
    radius: tuple[float, ...] = ()  #: of each component, if it is a rope in every frame and on every leg

    def __str__(self) -> str:
        if self.accepted:
            counts = {"leg": self.legs, "stage": self.stages, "obstacle": self.obstacles, "pin": self.pins}
            legs, stages, obstacles, pins = (f"{count} {noun}{'s' * (count != 1)}" for noun, count in counts.items())
            nor = f", nor with {obstacles}" if self.obstacles else ""
            held = f"; {pins} in place" if self.pins else ""
            radii = ", ".join(f"{radius:.4g}" for radius in dict.fromkeys(self.radius))
            rope = f"; a rope of radius {radii}" if self.radius else ""
            return f"accepted: no contact on {legs} in {stages}{nor}{held}{rope}"
        place = "" if self.stage is None else f"stage {self.stage}"
        place += "" if self.frame is None else f", frame {self.frame}"
        return f"rejected: {place}: {self.reason}" if place else f"rejected: {self.reason}"


# Polynomials: c[0] w^n + c[1] w^(n-1) v + ... + c[n] v^n with w = 1 - t, v = t, so that (a, b) goes from a to b.  Where
# 0 < t < 1 the sign is that of c[0] + c[1] u + ... in u = v / w > 0; divisions are of these polynomials in u.


def times(p: Sequence[int], q: Sequence[int]) -> Polynomial:
    result = [0] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result


def minus(p: Sequence[int], q: Sequence[int]) -> Polynomial:
    return [a - b for a, b in zip(p, q, strict=True)]


def plus(p: Sequence[int], q: Sequence[int]) -> Polynomial:
    return [a + b for a, b in zip(p, q, strict=True)]


def changes(p: Polynomial) -> int:
    """Changes of sign: as many as there are roots 0 < t < 1, counted with multiplicity, or an even number more."""
    signs = [c > 0 for c in p if c]
    return sum(a != b for a, b in pairwise(signs))


def between(p: Polynomial, i: int, j: int, m: int) -> Polynomial:
    """A positive multiple of the polynomial, with times 0 and 1 mapped to this one's i/m and j/m."""
    result = [0] * len(p)
    for k, c in enumerate(p):
        term = [c]
        for factor in [(m - i, m - j)] * (len(p) - 1 - k) + [(i, j)] * k:
            term = times(term, factor)
        result = plus(result, term)
    return result


def divided(p: Polynomial, q: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Quotient and remainder, each up to a factor."""
    rest, quotient = list(p), list[int]()
    while len(rest) >= len(q):
        lead, shift = rest[-1], len(rest) - len(q)
        quotient = [lead, *(q[-1] * c for c in quotient)]
        rest = minus([q[-1] * c for c in rest], [0] * shift + [lead * c for c in q])[:-1]
    return trimmed(quotient), trimmed(rest)


def trimmed(p: Polynomial) -> Polynomial:
    degree = max((k for k, c in enumerate(p) if c), default=-1)
    return [c // math.gcd(*p) for c in p[: degree + 1]]


def common_divisor(p: Polynomial, q: Polynomial) -> Polynomial:
    p, q = trimmed(p), trimmed(q)
    while q:
        p, q = q, divided(p, q)[1]
    return p


def roots(p: Polynomial) -> Iterator[Time]:
    """The roots 0 < t < 1 of a non-zero polynomial: (p, i, j, m) with i/m < t < j/m, or t = i/m = j/m."""
    work = [(0, 1, 1)] if changes(p) else []
    if work:
        p = divided(p, common_divisor(p, [k * c for k, c in enumerate(p)][1:]))[0]  # which has no multiple roots
    while work:
        i, j, m = work.pop()
        count = changes(between(p, i, j, m))
        if count == 1:
            yield p, i, j, m
        elif count > 1:
            if not between(p, i + j, i + j, 2 * m)[0]:
                yield p, i + j, i + j, 2 * m
            work += [(2 * i, i + j, 2 * m), (i + j, 2 * j, 2 * m)]


def halved(time: Time) -> Time:
    """The same root in half the interval, or as a known time."""
    p, i, j, m = time
    middle, m = i + j, 2 * m
    if not between(p, middle, middle, m)[0]:
        return p, middle, middle, m
    return (p, 2 * i, middle, m) if changes(between(p, 2 * i, middle, m)) % 2 else (p, middle, 2 * j, m)


def sign(q: Polynomial, time: Time) -> int:
    """A number that has the sign of a polynomial at a root, or at a known time."""
    p, i, j, m = time
    if changes(between(q, i, j, m)) and changes(between(common_divisor(p, q), i, j, m)) % 2:
        return 0  # the root is one of both
    while changes(here := between(q, i, j, m)):
        time = p, i, j, m = halved(time)
    return here[0] if i == j else sum(here)


# Contact: a point is a tuple of three whole numbers, a motion a pair of points, at the times 0 and 1.

START: Time = ([], 0, 0, 1)
END: Time = ([], 1, 1, 1)


def dot(u: Vector, v: Vector) -> int:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cross(u: Sequence[Any], v: Sequence[Any], multiplied: Any = mul, less: Any = int.__sub__) -> list[Any]:
    return [less(multiplied(u[i], v[j]), multiplied(u[j], v[i])) for i, j in ((1, 2), (2, 0), (0, 1))]


def contacts(*ends: Motion) -> Iterator[tuple[Time, int]]:
    """Yield when edges x0 x1 and y0 y1, whose four ends are motions, meet, and if they pass through each other the way.

    That is the sign that the volume det(x0 - y0, x1 - x0, y1 - y0) has afterwards, being opposite before, and 0 where
    they only touch.  If it is zero all the time, they touch all along, and the first and the last contact are yielded.
    """
    x0, x1, y0, y1 = (list(zip(*motion, strict=True)) for motion in ends)  # coordinates as polynomials in time
    a, b, c, d = (list(map(minus, p, q)) for p, q in ((x0, y0), (x0, y1), (x1, y0), (x1, y1)))
    e, f = list(map(minus, x1, x0)), list(map(minus, y1, y0))
    normal = cross(e, f, times, minus)
    volume = [sum(terms) for terms in zip(*map(times, normal, a), strict=True)]
    # for each end and the other edge: its distances from that edge's ends, and the area that they span
    beside = [(p, q, cross(g, p, times, minus)) for p, q, g in ((a, b, f), (c, d, f), (a, c, e), (b, d, e))]
    if any(volume):
        moments = chain([at for at in (START, END) if not sign(volume, at)], roots(volume))
    else:
        polynomials = chain(normal, a, b, c, d, *(area for _, _, area in beside))
        moments = chain((START, END), *(roots(p) for p in polynomials))
    for time in moments:
        # seen along an axis, edges in one plane meet if each has the ends of the other on both sides of it
        axis = next((k for k, component in enumerate(normal) if sign(component, time)), None)
        through = False
        if axis is not None:
            sides = [sign(area[axis], time) for _, _, area in beside]
            touch = sides[0] * sides[1] <= 0 and sides[2] * sides[3] <= 0
            through = all(sides) and any(volume) and bool(time[0])
        else:  # parallel, or of no length: an end of one is on the other
            touch = any(
                not any(sign(each, time) for each in area)
                and all(sign(p, time) * sign(q, time) <= 0 for p, q in zip(first, last, strict=True))
                for first, last, area in beside
            )
        if touch:
            order, slope = 0, volume  # of the root, and a derivative
            while through and not sign(slope, time):
                order, slope = order + 1, [k * c for k, c in enumerate(slope)][1:]
            way = sign(slope, time) if order % 2 else 0
            yield time, (way > 0) - (way < 0)


def meet(*ends: Motion) -> bool:
    """Whether edges x0 x1 and y0 y1, whose four ends are motions, have a common point at any time."""
    return any(True for _ in contacts(*ends))


def meet_triangle(x0: Motion, x1: Motion, *corners: Motion) -> bool:
    """Whether an edge meets a triangle whose corners are at rest; all are motions.

    If they are apart at first, then at first contact the edge meets one of the triangle's, or has an end inside it.
    """
    if any(meet(x0, x1, p, q) for p, q in combinations(corners, 2)):
        return True
    a, b, c = (corner for corner, _ in corners)
    normal = cross(minus(b, a), minus(c, a))
    for p, q in ((x0[0], x1[0]), x0, x1):  # segments that do not meet the triangle's edges
        before, after = dot(normal, minus(p, a)), dot(normal, minus(q, a))
        if any(normal) and before * after <= 0:
            along = normal if before == after else minus(q, p)  # the direction around which the corners turn
            turns = [dot(along, cross(minus(u, p), minus(v, p))) for u, v in ((a, b), (b, c), (c, a))]
            if min(turns) > 0 or max(turns) < 0:
                return True
    return False


def apart(first: Sequence[Motion], second: Sequence[Motion], halvings: int = 4, distance: int = 0) -> bool:
    """Whether fixed planes, each for a part of the time, separate an edge from another or a triangle, by their corners.

    The distance from a fixed plane is linear in time.  With a distance, both are further apart than that.
    """
    x, y = ([plus(*motion) for motion in corners] for corners in (first, second))  # halfway
    chord = [sum(column) for column in zip(*(minus(p, q) for p in x for q in y), strict=True)]
    e, *sides = (minus(q, p) for p, q in chain(combinations(x, 2), combinations(y, 2)))
    across = (cross(u, v) for u, v in chain(((e, side) for side in sides), combinations(sides[:2], 2)))
    for normal in chain([chord], (n if dot(n, chord) > 0 else [-c for c in n] for n in across)):
        above, below = ([[dot(normal, motion[t]) for motion in each] for t in (0, 1)] for each in (first, second))
        gap = min(min(above[t]) - max(below[t]) for t in (0, 1))
        if gap > 0 and gap**2 > distance**2 * dot(normal, normal):
            return True
    if not halvings:
        return False
    halves = [[(plus(p, p), plus(p, q), plus(q, q)) for p, q in corners] for corners in (first, second)]
    parts = [[[way[k : k + 2] for way in each] for each in halves] for k in (0, 1)]
    return all(apart(x, y, halvings - 1, 2 * distance) for x, y in parts)


def whole(points: Points) -> list[Vector]:
    """Points in space as whole numbers, in a unit of their own; the plane lies in space."""
    ratios = [[x.as_integer_ratio() for x in p] for p in points]
    unit = max(b for p in ratios for _, b in p)
    return [(*(a * (unit // b) for a, b in p), *[0] * (3 - len(p))) for p in ratios]


# Ropes: distances in space and along the curve, and corners.

PI = 3141592653589793, 10**15  # a fraction less than it


def inner(u: Sequence[Polynomial], v: Sequence[Polynomial]) -> Polynomial:
    return [sum(terms) for terms in zip(*map(times, u, v), strict=True)]


def stay_apart(first: Sequence[Motion], second: Sequence[Motion], distance: int) -> bool:
    """Whether an edge stays further than a distance from another, or from a still triangle that it does not meet.

    If it is further away at first and not always, then when it first is at that distance closest points are two ends,
    an end and a point inside the other edge or the triangle, or points inside both edges.  Each case has a polynomial
    that vanishes then, and others that tell whether feet are inside; one that is always zero needs no root, since then
    the distance was reached before, or a simpler case rules.
    """
    lift, square = [1, 2, 1], [distance * distance]
    x, y = ([list(map(list, zip(*motion, strict=True))) for motion in each] for each in (first, second))

    def less(p: Polynomial, q: Polynomial) -> Polynomial:
        """p - distance^2 q, where the degree of q may be two less."""
        q = times(square, q)
        return minus(p, times(q, lift) if len(q) < len(p) else q)

    def difference(p: Sequence[Polynomial], q: Sequence[Polynomial]) -> list[Polynomial]:
        return list(map(minus, p, q))

    cases: list[tuple[Polynomial, Polynomial, list[Polynomial]]]
    cases = [(less(inner(c, c), lift), lift, []) for c in (difference(p, q) for p in x for q in y)]
    sides = list(combinations(y, 2))
    for points, lines in ((x, sides), (y, [(x[0], x[1])])):
        for point, (a, b) in product(points, lines):
            c, line = difference(point, a), difference(b, a)
            h, along, whole_line = cross(line, c, times, minus), inner(c, line), inner(line, line)
            cases.append((less(inner(h, h), whole_line), whole_line, [along, minus(whole_line, along)]))
    e = difference(x[1], x[0])
    for a, b in sides:
        f, d = difference(b, a), difference(x[0], a)
        n = cross(e, f, times, minus)
        nn, volume = inner(n, n), inner(d, n)
        s, t = inner(cross(f, d, times, minus), n), inner(cross(e, d, times, minus), n)
        cases.append((less(times(volume, volume), nn), nn, [s, minus(nn, s), t, minus(nn, t)]))
    if len(y) == 3:
        normal = [[k] for k in cross(*(minus(corner[0], second[0][0]) for corner in second[1:]))]
        length = inner(normal, normal)
        for point in x:
            height = inner(normal, difference(point, y[0]))
            turns = [
                inner(cross(difference(b, a), difference(point, a), times, minus), normal)
                for a, b in ((y[0], y[1]), (y[1], y[2]), (y[2], y[0]))
            ]
            cases.append((less(times(height, height), times(length, lift)), length, turns))
    return not any(
        sign(gap, time) <= 0 < sign(positive, time) and all(sign(p, time) >= 0 for p in inside)
        for gap, positive, inside in cases
        for time in chain((START, END), roots(gap) if any(gap) else ())
    )


def products(u: Motion, v: Motion) -> tuple[int, int, int]:
    """Twice the inner product of moving vectors is between the least and the largest of these."""
    return 2 * dot(u[0], v[0]), dot(u[0], v[1]) + dot(u[1], v[0]), 2 * dot(u[1], v[1])


def normals(u: Motion, v: Motion) -> tuple[Vector, Vector, Vector]:
    """The same of twice the vector product."""
    first, last = ([2 * x for x in cross(u[t], v[t])] for t in (0, 1))
    return first, plus(cross(u[0], v[1]), cross(u[1], v[0])), last


def arcs_fit(edge: Motion, neighbours: Sequence[Motion], radius: int, halvings: int = 16) -> bool:
    """Whether arcs of a radius fit into the corners of an edge: radius (tan(a/2) + tan(b/2)) <= length, all vectors.

    tan(a/2) is |e x f| / (|e||f| + <e, f>).  Where bounds of these do not suffice, the time is halved.
    """
    tangents, own = Fraction(0), max(min(products(edge, edge)), 0)
    for other in neighbours:
        most = math.isqrt(max(dot(n, n) for n in normals(edge, other))) + 1
        least = math.isqrt(own * max(min(products(other, other)), 0)) + min(products(edge, other))
        if least <= 0:
            break
        tangents += Fraction(most, least)
    else:
        if radius * tangents <= math.isqrt(own // 2):
            return True
    if not halvings:
        return False
    halves = [(plus(u, u), plus(u, v), plus(v, v)) for u, v in (edge, *neighbours)]
    parts = ([way[k : k + 2] for way in halves] for k in (0, 1))
    return all(arcs_fit(part[0], part[1:], 2 * radius, halvings - 1) for part in parts)


def shortcut(e: Motion, f: Motion) -> Fraction:
    """By how much an arc of radius 1 shortens the way round a corner at all times: 2 (tan(a/2) - a/2), or less."""
    n = normals(e, f)
    least = min(dot(n[1], each) for each in n)
    most = math.isqrt(max(dot(u, u) for u in e) * max(dot(v, v) for v in f)) + 1
    below = (math.isqrt(dot(n[1], n[1])) + 1) * (2 * most + max(products(e, f)))
    if least <= 0 or below <= 0:
        return Fraction(0)
    x = Fraction((least << 40) // below, 1 << 40)
    small = x**3 / (3 + Fraction(9, 5) * x**2)
    if x <= 1:
        return 2 * small
    y = 1 / x
    return 2 * max(small, x - Fraction(15708, 10000) + y - y**3 / 3 + y**5 / 5 - y**7 / 7)


class Polygons:
    """Edges of polygons: to which vertex the one from each leads, which is the vertex itself where a polygon ends."""

    def __init__(self, sizes: Sequence[int], closed: Sequence[bool]) -> None:
        ends = [sum(sizes[: k + 1]) for k in range(len(sizes))]
        self.closed, self.parts = list(closed), [range(end - n, end) for n, end in zip(sizes, ends, strict=True)]
        self.heads = list(range(1, ends[-1] + 1))
        for part, is_closed in zip(self.parts, closed, strict=True):
            self.heads[part[-1]] = part[0] if is_closed else part[-1]

    def extra_pairs(self) -> Iterator[tuple[int, int, int, int]]:
        """A vertex, as an edge of no length, and an edge that must not meet it, although they are neighbours.

        Where neighbouring edges fold together, the edge after them is met too, except in triangles, where no vertex may
        meet the opposite edge, and in open polygons, where no end may meet the edge after its neighbour.
        """
        for v, closed in zip(self.parts, self.closed, strict=True):
            if closed and len(v) == 3:
                yield from ((v[k], v[k], v[k - 2], v[k - 1]) for k in range(3))
            elif not closed:
                yield v[0], v[0], v[1], v[:3][-1]
                yield v[-1], v[-1], v[-2], v[-3:][0]

    def edge_number(self, a: int, b: int) -> int:
        """Of the edge between two vertices, or of one at a vertex given twice; ends of open polygons begin none."""
        tail = b if self.heads[b] == a != b else a - (self.heads[a] == a)
        return sum(head != k for k, head in enumerate(self.heads[:tail]))


class RopeLeg:
    """Lengths along a rope during a leg.

    Points count if their distance along the curve that has arcs of the radius for corners is at least half a circle.
    Upper bounds of that distance: no edge is longer on the way than at both its ends.
    """

    STEPS, PARTS = 16, 1 << 44  # along the border of points that count, and of an edge

    def __init__(
        self, start: Points, end: Points, polygons: Polygons, radius: Sequence[float], halvings: int = 6
    ) -> None:
        n, heads, self.given = len(start), polygons.heads, (start, end, polygons, radius, halvings)
        # in a unit in which square roots may be rounded
        places = [[x << 64 for x in p] for p in whole([*start, *end, *((r,) for r in radius)])]
        self.ends = {k: [(places[v], places[n + v]) for v in (k, j)] for k, j in enumerate(heads) if j != k}
        self.radius = [p[0] for p in places[2 * n :]]
        self.part, self.closed = [k for k, each in enumerate(polygons.parts) for _ in each], polygons.closed
        self.edge = {k: tuple(map(minus, b, a)) for k, (a, b) in self.ends.items()}
        self.before, self.after = (
            {heads[k]: k for k in self.edge},
            {k: heads[k] for k in self.edge if heads[k] in self.edge},
        )
        self.longest = {k: math.isqrt(max(dot(e, e) for e in ends)) + 1 for k, ends in self.edge.items()}
        self.position, self.around = dict[int, int](), [0] * len(radius)
        for k, length in self.longest.items():
            c, before = self.part[k], self.before.get(k)
            saved = 0 if before is None else math.floor(self.radius[c] * shortcut(self.edge[before], self.edge[k]))
            self.position[k] = self.around[c] - saved
            self.around[c] += length - saved

    def arcs_fit(self, k: int) -> bool:
        """Whether arcs fit into the corners of an edge, given by its tail."""
        neighbours = [self.edge[j] for j in (self.before.get(k), self.after.get(k)) if j is not None]
        return arcs_fit(self.edge[k], neighbours, self.radius[self.part[k]])

    def stay_apart(self, i: int, j: int) -> bool:
        """Whether points of edges, given by their tails i < j, that count stay further apart than two radii.

        Where lengths change too much to tell which points count, the time is halved.
        """
        distance = self.PARTS * (self.radius[self.part[i]] + self.radius[self.part[j]])
        parts = ((self.piece(i, *p), self.piece(j, *q)) for p, q in self.parts(i, j))
        if all(apart(*pair, distance=distance) or stay_apart(*pair, distance) for pair in parts):
            return True
        return bool(self.halves) and all(half.stay_apart(i, j) for half in self.halves)

    @cached_property
    def halves(self) -> "list[RopeLeg]":
        """The leg in two, unless it has been halved often enough."""
        start, end, polygons, radius, halvings = self.given
        if not halvings or start is end:
            return []
        middle = [
            tuple((Fraction(x) + Fraction(y)) / 2 for x, y in zip(p, q, strict=True))
            for p, q in zip(start, end, strict=True)
        ]
        return [RopeLeg(a, b, polygons, radius, halvings - 1) for a, b in ((start, middle), (middle, end))]

    def piece(self, k: int, *shares: int) -> list[Motion]:
        """The ends of a part of an edge, in units that are so many parts of the usual one."""
        return [
            tuple(
                [(self.PARTS - s) * x + s * y for x, y in zip(u, v, strict=True)]
                for u, v in zip(*self.ends[k], strict=True)
            )
            for s in shares
        ]

    def parts(self, i: int, j: int) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
        """Parts of edges that contain all points that count."""
        entire, c = (0, self.PARTS), self.part[i]
        if c != self.part[j]:
            yield entire, entire
            return
        a, b, half = self.longest[i], self.longest[j], PI[0] * self.radius[c] // PI[1]
        ahead = self.position[j] - self.position[i] - a
        back = self.around[c] - self.position[j] - b + self.position[i] if self.closed[c] else half
        if min(ahead, back) + a + b < half or j in (self.after.get(i), self.before.get(i)):
            return  # no points count, or those of neighbours, which stay apart where arcs fit
        if min(ahead, back) >= half:
            yield entire, entire
            return
        # u, v and w are counted from the ends that are nearer along the curve
        rest = half - min(ahead, back)
        for k in range(self.STEPS):
            u = rest * (self.STEPS - 1 - k) * self.PARTS // (self.STEPS * a)
            v, w = (rest * step * self.PARTS // (self.STEPS * b) for step in (k, k + 1))
            w = self.PARTS if k == self.STEPS - 1 else min(w + 1, self.PARTS)
            if u <= self.PARTS and v <= self.PARTS:
                own, other = (0, self.PARTS - u), (v, w)
                yield ((u, self.PARTS), (self.PARTS - w, self.PARTS - v)) if back < ahead else (own, other)


def kept_vertices(first: Points, second: Points, closed: bool) -> tuple[list[int], list[int]]:
    """Indices, in both polygons, of the vertices they share; a RefusedError if these are few or not in order."""
    places = {p: k for k, p in enumerate(second)}
    here = [k for k, p in enumerate(first) if p in places]
    there = [places[first[k]] for k in here]
    if len(here) < 2 + closed:
        raise RefusedError(f"only {len(here)} vertices are kept")
    if not closed and [here[0], here[-1], there[0], there[-1]] != [0, len(first) - 1, 0, len(second) - 1]:
        raise RefusedError("an end of an open component is not kept")
    if sum(b <= a for a, b in pairwise([*there, there[0]])) != 1:
        raise RefusedError("the vertices that are kept are not in the same order")
    return here, there


def straightened(points: Points, kept: Sequence[int], closed: bool = True) -> dict[int, Coordinates]:
    """Exact places, on the edges between the vertices kept, of the others; a RefusedError if these are further away.

    Each lies within 16 units in the last place of the largest coordinate of it and of the edge's ends, and they are in
    order.  Places have 64 bits of the edge's parameter.
    """
    moved, n = dict[int, Coordinates](), len(points)
    for i, j in pairwise([*kept, kept[0] + n] if closed else kept):
        u, v = ([Fraction(x) for x in points[k % n]] for k in (i, j))
        edge, last = [b - a for a, b in zip(u, v, strict=True)], Fraction(0)
        square = sum(d * d for d in edge)
        for k in (k % n for k in range(i + 1, j)):
            along = sum((Fraction(x) - a) * d for x, a, d in zip(points[k], u, edge, strict=True))
            at = Fraction(math.floor(2**64 * along / square), 2**64) if square else Fraction(0)
            moved[k] = tuple(a + at * d for a, d in zip(u, edge, strict=True))
            unit = Fraction(math.ulp(max(abs(float(x)) for x in chain(points[i], points[j % n], points[k]))))
            near = max(abs(Fraction(x) - Fraction(y)) for x, y in zip(moved[k], points[k], strict=True)) <= 16 * unit
            if not (near and last < at < 1):
                raise RefusedError(f"vertex {k} of the component is not on the edge between its neighbours")
            last = at
    return moved


class Nearby:
    """The pairs on a leg that neither boxes nor planes show to be apart, by exact comparisons."""

    def __init__(self, triangles: Sequence[Points]) -> None:
        self.triangles, self.around = triangles, self._boxes(triangles)

    def __call__(self, start: Points, end: Points, polygons: Polygons, clearance: float) -> Iterator[tuple[int, ...]]:
        """Yield x0, x1, y0, y1 of pairs of edges, and x0, x1 and the triangle's number.

        ``clearance`` bounds how far doubles nearest to the coordinates are away: none here, where nothing is rounded.
        """
        edges = [(k, head) for k, head in enumerate(polygons.heads) if head != k]
        around = self._boxes([(start[a], end[a], start[b], end[b]) for a, b in edges])
        pairs = ((*edges[i], *edges[j]) for i, j in self._overlapping(around, around))
        for a, b, c, d in chain(polygons.extra_pairs(), (pair for pair in pairs if len({*pair}) == 4)):
            p = whole([points[k] for points in (start, end) for k in (a, b, c, d)])
            if not apart([(p[0], p[4]), (p[1], p[5])], [(p[2], p[6]), (p[3], p[7])]):
                yield a, b, c, d
        for i, j in self._overlapping(around, self.around):
            a, b = edges[i]
            p = whole([start[a], start[b], end[a], end[b], *self.triangles[j]])
            if not apart([(p[0], p[2]), (p[1], p[3])], [(q, q) for q in p[4:]]):
                yield a, b, j

    def crowded(
        self, start: Points, end: Points, polygons: Polygons, radius: Sequence[float]
    ) -> Iterator[tuple[int, int, int | None]]:
        """Yield what of a rope must be decided: tails of an edge and the same one, for its corners, or another one;
        ends of an edge, and a triangle."""
        edges, most = [(k, head) for k, head in enumerate(polygons.heads) if head != k], Fraction(max(radius))
        around = [
            (tuple(Fraction(x) - most for x in low), tuple(Fraction(x) + most for x in high))
            for low, high in self._boxes([(start[a], end[a], start[b], end[b]) for a, b in edges])
        ]
        yield from ((k, k, None) for k, _ in edges)
        yield from ((edges[i][0], edges[j][0], None) for i, j in self._overlapping(around, around))
        yield from ((*edges[i], j) for i, j in self._overlapping(around, self.around))

    @staticmethod
    def _boxes(groups: Sequence[Points]) -> list[Box]:
        columns = (list(zip(*group, strict=True)) for group in groups)
        return [(tuple(map(min, each)), tuple(map(max, each))) for each in columns]

    @staticmethod
    def _overlapping(first: Sequence[Box], second: Sequence[Box]) -> Iterator[tuple[int, int]]:
        """Indices of boxes, one of each list, that overlap; each pair once if both are the same list."""
        same, order = first is second, sorted(range(len(second)), key=lambda k: second[k][0])
        for place, i in enumerate(order if same else range(len(first))):
            low, high = first[i]
            for j in order[place + 1 if same else 0 :]:
                lower, upper = second[j]
                if lower[0] > high[0]:
                    break
                if all(a <= b for a, b in chain(zip(low, upper, strict=True), zip(lower, high, strict=True))):
                    yield i, j


Sieve = Any  # `Nearby`, or what does as it does


class Archive(zipfile.ZipFile):
    """The arrays of a trajectory file, of which nothing is trusted; any damage is a TrajectoryError.

    One frame is in memory at a time (in Fortran order, one stage), and memory is taken only for data that the file
    really has.  What a few bytes unpack to is bounded as well, as it may take hours to check.
    """

    def __init__(self, path: Path) -> None:
        with self._damage():
            with open(path, "rb") as stream:
                if stream.read(23) == b"version https://git-lfs":
                    raise TrajectoryError("the file is a pointer of Git LFS, not the trajectory: run git lfs pull")
            super().__init__(path)
            self.names = self.namelist()
            # bytes that the arrays of any file may have together, and times its size that others may
            if sum(info.file_size for info in self.infolist()) > max(1 << 24, 20 * stat(path).st_size):
                raise TrajectoryError("the file unpacks to more than 20 times its size; write it with numpy.savez")
        if len(set(self.names)) < len(self.names):
            raise TrajectoryError("the file has two arrays of one name")

    @staticmethod
    @contextmanager
    def _damage() -> Iterator[None]:
        try:
            yield
        except TrajectoryError:
            raise
        except (OSError, EOFError, zipfile.BadZipFile, zlib.error, struct.error, RuntimeError, ValueError) as error:
            raise TrajectoryError(f"the file cannot be read: {getattr(error, 'strerror', None) or error}") from error

    def array(self, name: str, kinds: Mapping[str, str], dimension: int, what: str) -> Rows:
        """Yield the shape of an array of one of some types, then for each first index its entries, in C order."""
        if f"{name}.npy" not in self.names:
            raise TrajectoryError(f"{name} is missing")
        info, at_once = self.getinfo(f"{name}.npy"), 1 << 26  # bytes in memory
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise TrajectoryError(f"{name} is packed by a method that NumPy does not use; write it with numpy.savez")
        with self._damage(), self.open(info) as stream:
            magic = stream.read(8)
            if len(magic) < 8:
                raise TrajectoryError(f"{name} is shorter than its header says")
            if magic not in (b"\x93NUMPY\1\0", b"\x93NUMPY\2\0"):
                raise TrajectoryError(f"{name} is not an array in NumPy's format 1.0 or 2.0")
            length = int.from_bytes(stream.read(2 * magic[6]), "little")
            if length > 1000:
                raise TrajectoryError(f"{name} has a header of {length} bytes, which is too long")
            try:
                header: Any = ast.literal_eval(stream.read(length).decode("latin1"))
                descr, fortran, shape = header.pop("descr"), header.pop("fortran_order"), header.pop("shape")
                right = not header and isinstance(descr, str) and isinstance(fortran, bool) and isinstance(shape, tuple)
            except (AttributeError, KeyError, MemoryError, RecursionError, SyntaxError, TypeError, ValueError):
                right = False
            if not right or not all(type(n) is int for n in shape):
                raise TrajectoryError(f"{name} has a header that cannot be read")
            if min(shape, default=0) < 0:
                raise TrajectoryError(f"{name} has a negative shape")
            if descr not in kinds or len(shape) != dimension:
                raise TrajectoryError(f"{name} is an array {shape} of {descr}; it must be {what}")
            yield shape
            order, code, count, each = kinds[descr][0], kinds[descr][1], shape[0], math.prod(shape[1:])
            size, have = struct.calcsize(f"={code}"), info.file_size - stream.tell()
            if size * each * (count if dimension < 3 else 1) > at_once:
                raise TrajectoryError(f"{name} has shape {shape}, more than this program takes")
            if fortran and size * each * count > at_once:
                raise TrajectoryError(f"{name} is in Fortran order and large; write it with numpy.ascontiguousarray")
            if have != size * each * count:
                kind = "shorter" if have < size * each * count else "longer"
                raise TrajectoryError(f"{name} is {kind} than its header says")
            if fortran:
                every = struct.unpack(f"{order}{count * each}{code}", stream.read())
                steps = [math.prod(shape[:k]) for k in range(1, dimension)]
                places = [sum(map(mul, place, steps)) for place in product(*map(range, shape[1:]))]
            for k in range(count):
                if fortran:
                    values = tuple(every[k + place] for place in places)
                else:
                    values = struct.unpack(f"{order}{each}{code}", stream.read(size * each))
                # the sum of finite ones is fast, and may yet overflow
                if not math.isfinite(sum(values)) and not all(map(math.isfinite, values)):
                    where = f"{name}, frame {k}" if dimension == 3 else name
                    raise TrajectoryError(f"{where}: a coordinate is not finite")
                yield values

    def numbered(self, kind: str, *parts: str) -> list[str]:
        """The names, without parts, of the arrays of a kind, numbered from 000 on; each must have all its parts."""
        found = {name for name in self.names if name.startswith(f"{kind}_")}
        names = [f"{kind}_{k:03d}" for k in range(len(found) // len(parts))]
        if found != {f"{a}{b}.npy" for a, b in product(names, parts)} or (kind == "stage" and not names):
            raise TrajectoryError(f"the {kind}s are not numbered {kind}_000, {kind}_001, …, each once and whole")
        return names

    def points(self, name: str, dimensions: Sequence[int]) -> list[Coordinates]:
        """The rows of a table of coordinates."""
        rows = self.array(name, FLOATS, 2, "a table of float64")
        if (shape := next(rows))[1] not in dimensions:
            columns = " or ".join(map(str, dimensions))
            raise TrajectoryError(f"{name} has shape {shape}; it must have {columns} columns")
        return list(rows)

    def radius(self) -> list[float]:
        """Of each component as a rope; none if it is said to be none."""
        if "radius.npy" not in self.names:
            return []
        radius = [r for (r,) in list(self.array("radius", FLOATS, 1, "a list of float64"))[1:]]
        if not radius or min(radius) <= 0:
            raise TrajectoryError("radius must have a number above 0 for each component")
        return radius

    def triangles(self, name: str) -> list[Points]:
        """Of an obstacle; a segment becomes a triangle without area."""
        points = self.points(f"{name}_vertices", [3])
        rows = self.array(f"{name}_faces", WHOLE, 2, "a table of whole numbers")
        shape = next(rows)
        if shape[1] not in (2, 3):
            raise TrajectoryError(f"{name}_faces has shape {shape}; it must be (f, 3) or (f, 2)")
        faces = list(rows)
        if not faces:
            raise TrajectoryError(f"{name}_faces is empty; an obstacle has at least one")
        if not all(0 <= k < len(points) for k in chain(*faces)):
            raise TrajectoryError(f"{name}_faces: an index has no vertex")
        return [[points[face[k]] for k in (0, 1, -1)] for face in faces]

    def components(self, name: str) -> tuple[list[int], list[bool]]:
        """Of a stage: how many vertices they have, and whether they are closed."""
        wanted, flags = (name.replace("stage", f"component_{kind}") for kind in ("sizes", "closed"))
        sizes = [n for (n,) in list(self.array(wanted, WHOLE, 1, "a list of whole numbers"))[1:]]
        closed = [True] * len(sizes)
        if f"{flags}.npy" in self.names:
            closed = [each for (each,) in list(self.array(flags, FLAGS, 1, "a list of truth values"))[1:]]
        if not sizes:
            raise TrajectoryError(f"{wanted} is empty; there must be a component")
        if len(closed) != len(sizes):
            raise TrajectoryError(f"{flags} tells of {len(closed)} components, {wanted} of {len(sizes)}")
        for n, is_closed in zip(sizes, closed, strict=True):
            if n < 2 + is_closed:
                least = "a closed polygon has 3" if is_closed else "an open polygon has 2"
                raise TrajectoryError(f"{wanted} has a component with {n} vertices; {least} or more")
        return sizes, closed

    def frames(self, name: str, vertices: int) -> Iterator[list[Coordinates]]:
        """The frames of a stage with a number of vertices."""
        rows = self.array(name, FLOATS, 3, "(k, n, m) of float64")
        count, n, m = shape = next(rows)
        if n != vertices:
            raise TrajectoryError(f"{name} has {n} vertices, but its components have {vertices}")
        if count < 1 or m not in (2, 3):
            raise TrajectoryError(f"{name} has shape {shape}; frames there must be, in dimension 2 or 3")
        return (list(zip(*(values[k::m] for k in range(m)), strict=True)) for values in rows)


@dataclass
class Findings:
    """What has been found out about a file so far."""

    sieve: Sieve
    triangles: list[Points]
    obstacle: list[int]  # the obstacle of each triangle
    pins: list[Coordinates]
    radius: list[float]  # of each component as a rope, if it is one
    stages: int = 0
    legs: int = 0
    frame: int | None = None
    decided: float = 0.0

    def file(self, archive: Archive, tell: Callable[[int], object]) -> None:
        """Check all stages; raise at the first thing that is wrong."""
        before: tuple[list[Coordinates], Polygons] | None = None
        for name in archive.numbered("stage", ""):
            self.stages, self.frame = self.stages + 1, None
            sizes, closed = archive.components(name)
            frames = archive.frames(name, sum(sizes))
            last = next(frames)
            polygons = Polygons(sizes, closed)
            if self.triangles and len(last[0]) != 3:
                raise TrajectoryError(f"{name} is not in space, as obstacles are")
            if before:
                self.change(*before, last, polygons)
            self.frame = 0
            vertices = {p: k for k, p in enumerate(last)}
            for number, pin in enumerate(self.pins):
                if pin not in vertices:
                    raise RefusedError(f"no vertex is at pin {number + 1} (counted from 1)")
            if self.radius and len(self.radius) != len(sizes):
                raise TrajectoryError(f"radius has {len(self.radius)} numbers, but {name} has {len(sizes)} components")
            self.leg(last, last, polygons)  # a single frame is a polygon, too
            self.rope(last, last, polygons)
            for frame in frames:
                self.legs += 1
                for number, pin in enumerate(self.pins):
                    if frame[vertices[pin]] != pin:
                        raise RefusedError(f"vertex {vertices[pin] + 1} leaves pin {number + 1} (counted from 1)")
                self.leg(last, frame, polygons)
                self.rope(last, frame, polygons)
                last, self.frame = frame, self.frame + 1
                tell(self.legs)
            before = last, polygons

    def change(self, old: Points, first: Polygons, new: Points, second: Polygons) -> None:
        """Check a change of stage: both polygons must reach the one of their common vertices without contact."""
        if len(first.parts) != len(second.parts) or len(old[0]) != len(new[0]):
            raise RefusedError("the stage before has another number of components or another dimension")
        if first.closed != second.closed:
            raise RefusedError("a component is closed in one of two stages and open in the other")
        pairs = zip(first.parts, second.parts, first.closed, strict=True)
        kept = [kept_vertices(old[a[0] : a[-1] + 1], new[b[0] : b[-1] + 1], closed) for a, b, closed in pairs]
        for points, polygons, side in ((old, first, 0), (new, second, 1)):
            moved = dict[int, Coordinates]()
            for part, closed, both in zip(polygons.parts, polygons.closed, kept, strict=True):
                places = straightened(points[part[0] : part[-1] + 1], sorted(both[side]), closed)
                moved |= {part[0] + k: place for k, place in places.items()}
            if any(place != points[k] for k, place in moved.items()):
                rounding = math.ulp(max(abs(float(x)) for x in chain(*points)))
                self.leg(points, [moved.get(k, p) for k, p in enumerate(points)], polygons, rounding)

    def leg(self, start: Points, end: Points, polygons: Polygons, clearance: float = 0.0) -> None:
        """Raise if edges meet, or an edge an obstacle, while vertices go from start to end."""
        for a, b, *other in self.sieve(start, end, polygons, clearance):
            moving, still = (a, b, *other), tuple[Coordinates, ...]()
            if len(other) == 1:
                moving, still = (a, b), tuple(self.triangles[other[0]])
            places = whole([*(start[k] for k in moving), *still, *(end[k] for k in moving), *still])
            half = len(places) // 2
            ways = list(zip(places[:half], places[half:], strict=True))
            # long numbers take longer; runs need one decision in a hundred legs, files made to take days millions
            self.decided += max(1.0, max(map(abs, chain(*places))).bit_length() / 64) ** 1.5
            if self.decided > 1500 + 100 * self.legs:
                raise RefusedError(
                    "too many edges are so near to each other that rounding hides whether they meet; "
                    "write a trajectory whose strands are further apart"
                )
            if still:
                if meet_triangle(*ways):
                    edge, obstacle = polygons.edge_number(a, b), self.obstacle[other[0]]
                    message = f"edge {edge + 1} meets obstacle {obstacle + 1} (counted from 1)"
                    raise RefusedError(message, (edge,), obstacle)
            elif meet(*ways):
                c, d = other
                edge, second = polygons.edge_number(a, b), polygons.edge_number(c, d)
                message = f"edges {edge + 1} and {second + 1} (counted from 1) meet"
                if a == b:
                    kind = "a triangle" if polygons.heads[d] == a and c != d else "an open polygon"
                    message = f"{kind} collapses at vertex {a + 1}"
                raise RefusedError(message, (edge, second))

    def rope(self, start: Points, end: Points, polygons: Polygons) -> None:
        """Raise if the curve is no rope at some time of a leg: corners, strands, and obstacles."""
        leg: RopeLeg | None = None
        for a, b, triangle in self.sieve.crowded(start, end, polygons, self.radius) if self.radius else ():
            leg = leg or RopeLeg(start, end, polygons, self.radius)
            number, other = (polygons.edge_number(k, polygons.heads[k]) for k in (a, b))
            if triangle is not None:
                p = whole([start[a], start[b], end[a], end[b], *self.triangles[triangle], (self.radius[leg.part[a]],)])
                if not stay_apart([(p[0], p[2]), (p[1], p[3])], [(q, q) for q in p[4:7]], p[7][0]):
                    found = self.obstacle[triangle]
                    message = f"edge {number + 1} comes within a radius of obstacle {found + 1} (counted from 1)"
                    raise RefusedError(message, (number,), found)
            elif a == b and not leg.arcs_fit(a):
                raise RefusedError(f"the rope bends too sharply at edge {number + 1} (counted from 1)", (number,))
            elif a != b and not leg.stay_apart(min(a, b), max(a, b)):
                message = f"edges {number + 1} and {other + 1} (counted from 1) come within two radii"
                raise RefusedError(message, (number, other))


def check(
    path: Path,
    sieve: Callable[[list[Points]], Sieve] = Nearby,
    callback: Callable[[int, int], object] | None = None,
) -> Verdict:
    """Check a trajectory file; damaged files and failed checks give a verdict that is not accepted.

    ``sieve`` makes, from all triangles, what yields the pairs on a leg that may meet.  ``callback`` is called after
    every leg with the number of legs checked and, by its headers, of those in the file.
    """
    found, what = None, dict[str, Any]()
    try:
        with Archive(path) as archive:
            names = archive.numbered("obstacle", "_faces", "_vertices")
            parts = [archive.triangles(name) for name in names]
            what["obstacles"] = len(parts)
            pins = archive.points("pins", [2, 3]) if "pins.npy" in archive.names else []
            radius = archive.radius()
            what |= {"pins": len(pins), "radius": tuple(radius)}
            total = 0
            triangles, obstacle = [*chain(*parts)], [k for k, part in enumerate(parts) for _ in part]
            found = Findings(sieve(triangles), triangles, obstacle, pins, radius)
            with suppress(TrajectoryError):
                for name in archive.numbered("stage", ""):
                    total += max(next(archive.array(name, FLOATS, 3, ""))[0] - 1, 0)
            found.file(archive, (lambda done: callback(done, total)) if callback else lambda done: None)
    except TrajectoryError as error:
        what["reason"] = str(error)
    except RefusedError as error:
        what |= {"reason": str(error), "edges": error.edges, "obstacle": error.obstacle}
        what |= {"stage": found.stages - 1, "frame": found.frame} if found else {}
    stages, legs = (found.stages, found.legs) if found else (0, 0)
    return Verdict("reason" not in what, stages, legs, **what)


if __name__ == "__main__":
    verdicts = [(path, check(path)) for path in sys.argv[1:]]
    print(*(f"{path}: {verdict}" for path, verdict in verdicts) if verdicts else [__doc__], sep="\n")
    sys.exit(0 if verdicts and all(verdict.accepted for _, verdict in verdicts) else 1)
