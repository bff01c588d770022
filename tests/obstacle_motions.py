"""Motions of a segment near a triangle, tame and nasty, and the exact time of their first contact.

A motion has the rows x₀, x₁ of the segment and y₀, y₁, y₂ of the triangle, which are the same at both times.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

import numpy as np
import numpy.typing as npt
from exact_times import meetings
from mobius_flow.core import Mesh, Obstacle
from mobius_flow.core.collision import Limit, free_motion

Array = npt.NDArray[np.float64]
Motion = tuple[Array, Array]
Rng = np.random.Generator


def still(start: Array, end: Array) -> Motion:
    """The motion whose triangle stays where it is at the start."""
    return start, np.concatenate([end[:2], start[2:]])


def gaussian(rng: Rng) -> Motion:
    start = rng.normal(size=(5, 3))
    return still(start, start + rng.choice([0.1, 1.0, 5.0]) * rng.normal(size=(5, 3)))


def lattice(rng: Rng) -> Motion:
    """Corners on a small lattice: coplanar, parallel, touching, of no length, of no area."""
    size = int(rng.integers(1, 4))
    start, end = rng.integers(-size, size + 1, size=(2, 5, 3)).astype(float)
    return still(start, end)


def _plane_frame(rng: Rng) -> Array:
    """A rotation by small whole numbers, so that what is in a plane stays exactly there."""
    frames = [np.eye(3), np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]]), np.array([[1.0, 1, 0], [0, 1, 2], [1, 0, 3]])]
    return frames[rng.integers(len(frames))]


def in_plane(rng: Rng) -> Motion:
    """The segment slides in the plane of the triangle, or comes into it, or leaves it."""
    start, end = rng.integers(-3, 4, size=(2, 5, 3)).astype(float)
    start[:, 2] = end[:, 2] = 0.0
    height = rng.choice([0.0, 0.0, 1.0, 2.0], size=2)
    start[:2, 2], end[:2, 2] = height[0], height[1] * rng.choice([-1.0, 1.0])
    frame = _plane_frame(rng)
    return still(start @ frame, end @ frame)


def inside(rng: Rng) -> Motion:
    """The segment is small and in the plane of the triangle, at the start or all the time, mostly in its interior."""
    triangle = np.array([[-6.0, -6.0, 0.0], [12.0, -6.0, 0.0], [-6.0, 12.0, 0.0]])
    start, end = (np.concatenate([rng.integers(-3, 6, size=(2, 3)) * [1.0, 1.0, 0.0], triangle]) for _ in range(2))
    end[:2] = start[:2] if rng.random() < 0.3 else end[:2]
    end[:2, 2] = rng.choice([0.0, 1.0, -1.0]) * np.array([1.0, rng.choice([0.0, 1.0])])
    if rng.random() < 0.3:
        start, end = end, start
    frame = _plane_frame(rng)
    return still(start @ frame, end @ frame)


def graze_face(rng: Rng) -> Motion:
    """An end turns round at a small distance above or below a point of the triangle, or of its edge, or a corner."""
    start, end = gaussian(rng)
    weights = rng.choice([[0.2, 0.3, 0.5], [0.0, 0.4, 0.6], [1.0, 0.0, 0.0], [1e-9, 0.5, 0.5 - 1e-9]])
    t = rng.uniform(0.05, 1.0)
    normal = np.cross(start[3] - start[2], start[4] - start[2])
    gap = rng.choice([0.0, 1e-9, -1e-9, 1e-12, -1e-12]) * normal / np.linalg.norm(normal)
    shift = weights @ start[2:] + gap - ((1 - t) * start[0] + t * end[0])
    start[:2] += shift
    end[:2] += shift
    return start, end


def graze_edge(rng: Rng) -> Motion:
    """The segment meets an edge of the triangle at a known time, or misses it by little."""
    start, end = gaussian(rng)
    t, s, r = rng.uniform(0.05, 0.95), *rng.choice([0.0, 0.3, 0.8, 1.0], size=2)
    x = (1 - t) * ((1 - s) * start[0] + s * start[1]) + t * ((1 - s) * end[0] + s * end[1])
    y = (1 - r) * start[2] + r * start[3]
    away = y - start[2:].mean(axis=0)
    shift = y + rng.choice([0.0, 1e-9, -1e-9, 1e-12, 1e-3]) * away - x
    start[:2] += shift
    end[:2] += shift
    return start, end


def needle(rng: Rng) -> Motion:
    """A triangle with hardly any area, or none, or that is a point."""
    start, end = (graze_edge if rng.random() < 0.5 else graze_face)(rng)
    thin = rng.choice([0.0, 1e-16, 1e-12, 1e-6])
    along = rng.choice([0.0, 0.5, 1.5])
    for frame in (start, end):
        frame[4] = frame[2] + along * (frame[3] - frame[2]) + thin * (frame[4] - frame[2])
    if rng.random() < 0.1:
        start[3:] = end[3:] = start[2]
    return start, end


def sizes_apart(rng: Rng) -> Motion:
    """A triangle much smaller, or larger, than the edge, or of very different edges."""
    start, end = (graze_edge if rng.random() < 0.5 else graze_face)(rng)
    ratio = 10.0 ** rng.choice([-9, -6, -3, 3, 6])
    rows = rng.choice([2, 3, 4])
    start[rows:] = start[2] + ratio * (start[rows:] - start[2])
    return still(start, end)


def slow(rng: Rng) -> Motion:
    """Hardly any motion, from near contact."""
    start, end = (graze_edge if rng.random() < 0.5 else graze_face)(rng)
    middle = 0.5 * (start[:2] + end[:2])
    return still(np.concatenate([middle, start[2:]]), np.concatenate([middle + 1e-6 * (end - start)[:2], start[2:]]))


def through(rng: Rng) -> Motion:
    """The segment pierces the triangle at the start, or an edge of it passes just by the triangle's corner."""
    start, end = gaussian(rng)
    weights = rng.dirichlet([1.0, 1.0, 1.0]) if rng.random() < 0.6 else np.array([1.0 + 1e-9, 0.0, -1e-9])
    middle = weights @ start[2:]
    shift = middle - 0.5 * (start[0] + start[1])
    start[:2] += shift
    end[:2] += shift
    return start, end


def glide(rng: Rng) -> Motion:
    """An edge parallel to the triangle, a hair above it, that slides over its edges and turns."""
    start = np.zeros((5, 3))
    start[:2, :2] = rng.normal(size=(2, 2))
    start[2:, :2] = rng.normal(size=(3, 2))
    end = start.copy()
    end[:2, :2] = 2 * rng.normal(size=(2, 2))
    heights = rng.choice([1e-9, 1e-12, 0.0, 1e-3], size=2) * rng.choice([1.0, 1.0, -1.0], size=2)
    start[:2, 2], end[:2, 2] = heights
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0] if rng.random() < 0.5 else _plane_frame(rng)
    return still(start @ turn, end @ turn)


KINDS: tuple[Callable[[Rng], Motion], ...] = (
    gaussian,
    lattice,
    in_plane,
    inside,
    graze_face,
    graze_edge,
    needle,
    sizes_apart,
    slow,
    through,
    glide,
)


def placed(rng: Rng, motion: Motion) -> Motion:
    """The same in other units, and perhaps far from the origin."""
    scale = rng.choice([1.0, 2.0**-70, 1e-6, 1e6, 2.0**80])
    offset = rng.choice([0.0, 0.0, 1e3]) * scale * rng.normal(size=3)
    return still(motion[0] * scale + offset, motion[1] * scale + offset)


def first_contact(motion: Motion) -> tuple[Fraction, Fraction] | None:
    """A short interval in which the first contact is, decided by rational arithmetic; None if there is none.

    A segment that shrinks to a point touches itself.  Asks the verifier's code, which shares none with the program's.
    """
    start, end = ([[Fraction(x) for x in p] for p in points.tolist()] for points in motion)
    triangle = start[2:]
    if pierced_at(start[0], start[1], triangle) is not None:
        return Fraction(0), Fraction(0)
    times = [pierced_at(start[k], end[k], triangle) for k in (0, 1)] + [shrunk_at(start[:2], end[:2])]
    found = [(time, time) for time in times if time is not None]
    for a, b in combinations(triangle, 2):
        found += [(root.low, root.high) for root in meetings([*start[:2], a, b], [*end[:2], a, b])]
    return min(found, default=None)


def shrunk_at(start: Sequence[Sequence[Fraction]], end: Sequence[Sequence[Fraction]]) -> Fraction | None:
    """The first time at which both ends of a segment are the same point; None if there is none."""
    before, after = ([x - y for x, y in zip(*ends, strict=True)] for ends in (start, end))
    time = next((a / (a - b) for a, b in zip(before, after, strict=True) if a != b), Fraction(0))
    meets = 0 <= time <= 1 and all((1 - time) * a + time * b == 0 for a, b in zip(before, after, strict=True))
    return time if meets else None


def almost_shrinks(motion: Motion) -> bool:
    """Whether the segment gets so short that only rounding decides whether it is a point."""
    before, after = (points[1] - points[0] for points in motion)
    change = after - before
    time = np.clip(-before @ change / max(change @ change, np.finfo(float).tiny), 0.0, 1.0)
    return bool(np.linalg.norm(before + time * change) <= 8 * np.finfo(float).eps * np.abs(motion).max())


def pierced_at(p: Sequence[Fraction], q: Sequence[Fraction], triangle: Sequence[Sequence[Fraction]]) -> Fraction | None:
    """The parameter at which the segment from p to q meets a triangle; None if it does not.

    By Cramer's rule for p + s (q − p) = y₀ + r f + t g. If they are in one plane it is 0, or None if p is not in the
    triangle: whether the segment meets its edges must be decided elsewhere.
    """
    y0, y1, y2 = triangle
    f, g, d, D = _difference(y1, y0), _difference(y2, y0), _difference(p, q), _difference(p, y0)
    volume = _det(d, f, g)
    if volume == 0:
        return Fraction(0) if _in_plane_and_inside(D, f, g) else None
    s, r, t = (_det(*columns) / volume for columns in ((D, f, g), (d, D, g), (d, f, D)))
    inside = 0 <= s <= 1 and r >= 0 and t >= 0 and r + t <= 1
    return s if inside else None


def _in_plane_and_inside(D: Sequence[Fraction], f: Sequence[Fraction], g: Sequence[Fraction]) -> bool:
    """Whether D = r f + t g with r, t ≥ 0 and r + t ≤ 1, for a triangle with an area; by the normal equations."""
    ff, fg, gg, Df, Dg = _inner(f, f), _inner(f, g), _inner(g, g), _inner(D, f), _inner(D, g)
    whole = ff * gg - fg * fg
    if whole == 0 or _det(D, f, g) != 0:
        return False
    r, t = (Df * gg - Dg * fg) / whole, (Dg * ff - Df * fg) / whole
    return r >= 0 and t >= 0 and r + t <= 1


def _difference(u: Sequence[Fraction], v: Sequence[Fraction]) -> Sequence[Fraction]:
    return [a - b for a, b in zip(u, v, strict=True)]


def _inner(u: Sequence[Fraction], v: Sequence[Fraction]) -> Fraction:
    return sum((a * b for a, b in zip(u, v, strict=True)), Fraction(0))


def _det(u: Sequence[Fraction], v: Sequence[Fraction], w: Sequence[Fraction]) -> Fraction:
    products = (u[i] * (v[j] * w[k] - v[k] * w[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    return sum(products, Fraction(0))


def touching(corners: Array) -> bool:
    """Whether a segment and a triangle that stand still have a common point, in rational arithmetic.

    If so, 0 is in the convex hull of the six differences of their vertices, and then of at most four of these that are
    affinely independent (Carathéodory).
    """
    points = [[Fraction(a) - Fraction(b) for a, b in zip(x, y, strict=True)] for x in corners[:2] for y in corners[2:]]
    return any(_weights_exist(subset) for size in range(1, 5) for subset in combinations(points, size))


def _weights_exist(points: Sequence[Sequence[Fraction]]) -> bool:
    """Whether 0 = Σ wᵢ pᵢ with Σ wᵢ = 1 has exactly one solution, and w ≥ 0; by Gauss–Jordan elimination."""
    rows = [[*(p[k] for p in points), Fraction(0)] for k in range(3)] + [[Fraction(1)] * (len(points) + 1)]
    for column in range(len(points)):
        pivot = next((row for row in rows[column:] if row[column] != 0), None)
        if pivot is None:
            return False
        rows.remove(pivot)
        pivot = [x / pivot[column] for x in pivot]
        rows = [[x - row[column] * y for x, y in zip(row, pivot, strict=True)] for row in rows]
        rows.insert(column, pivot)
    return all(row[-1] >= 0 for row in rows[: len(points)]) and all(row[-1] == 0 for row in rows[len(points) :])


ONE_EDGE = Mesh((2,), (False,))


@dataclass
class Tally:
    """How answers compare with exact ones.

    Attributes
    ----------
    hits, misses
        Motions with a contact, and without any.
    wrong
        Contacts that were not seen, or only after they had happened.
    timid
        Motions without contact that were refused, but for those of segments that almost shrink to a point.
    worst_time
        The least part of the time of a contact that was proved.
    """

    hits: int = 0
    misses: int = 0
    wrong: int = 0
    timid: int = 0
    worst_time: float = 1.0

    def add(self, motion: Motion) -> None:
        """Compare the answer for one motion."""
        (start, end), contact = motion, first_contact(motion)
        obstacle = Obstacle(start[2:], [[0, 1, 2]])
        answer = free_motion(ONE_EDGE, start[:2], end[:2], (obstacle,))
        if contact is None:
            self.misses += 1
            self.timid += not answer.proved and not almost_shrinks(motion)
            return
        low, high = contact
        self.hits += 1
        if high == 0:
            self.wrong += answer.limit is not Limit.TOUCHING_START
            return
        self.wrong += answer.proved or not (Fraction(answer.time) <= low or answer.time == 0.0)
        self.worst_time = min(self.worst_time, answer.time / float(high))
