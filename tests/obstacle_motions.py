"""Motions of a segment near a triangle, tame and nasty, and convex hulls that decide whether the two touch.

A motion has the rows x₀, x₁ of the segment and y₀, y₁, y₂ of the triangle, which are the same at both times.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

import numpy as np
import numpy.typing as npt
from exact_decisions import meet, meet_triangle
from mobius_flow.core import Mesh, Obstacle
from mobius_flow.core.collision import FreeMotion, free_motion

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


KINDS = (gaussian, lattice, in_plane, inside, graze_face, graze_edge, needle, sizes_apart, slow, through, glide)


def placed(rng: Rng, motion: Motion) -> Motion:
    """The same in other units, and perhaps far from the origin."""
    scale = rng.choice([1.0, 2.0**-70, 1e-6, 1e6, 2.0**80])
    offset = rng.choice([0.0, 0.0, 1e3]) * scale * rng.normal(size=3)
    return still(motion[0] * scale + offset, motion[1] * scale + offset)


def meets(start: Array, end: Array) -> bool:
    """Whether the segment meets the triangle, or shrinks to a point, where it touches itself."""
    return meet_triangle(start, end) or meet(start[[0, 0, 1, 1]], end[[0, 0, 1, 1]])


def free(start: Array, end: Array) -> FreeMotion:
    """What is proved of a motion by the search."""
    return free_motion(Mesh((2,), (False,)), start[:2], end[:2], (Obstacle(start[2:], [[0, 1, 2]]),))


def almost_shrinks(motion: Motion) -> bool:
    """Whether the segment gets so short that only rounding decides whether it is a point."""
    before, after = (points[1] - points[0] for points in motion)
    change = after - before
    time = np.clip(-before @ change / max(change @ change, np.finfo(float).tiny), 0.0, 1.0)
    return bool(np.linalg.norm(before + time * change) <= 8 * np.finfo(float).eps * np.abs(motion).max())


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
