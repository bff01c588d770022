"""Motions of quadrilaterals, tame and nasty."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Motion = tuple[Array, Array]
Rng = np.random.Generator


def gaussian(rng: Rng, m: int) -> Motion:
    start = rng.normal(size=(4, m))
    return start, start + rng.choice([0.1, 1.0, 5.0]) * rng.normal(size=(4, m))


def lattice(rng: Rng, m: int) -> Motion:
    """Corners on a small lattice: parallel, collinear, touching at the start or in passing, with edges of no length."""
    return (rng.integers(-2, 3, size=(4, m)).astype(float), rng.integers(-2, 3, size=(4, m)).astype(float))


def graze(rng: Rng, m: int) -> Motion:
    """Two edges meet at a known time, or miss each other by 1e-9 there."""
    start, end = gaussian(rng, m)
    t = rng.uniform(0.05, 0.95)
    s, r = rng.choice([0.0, 0.3, 0.8, 1.0], size=2) if m == 3 else (rng.choice([0.0, 1.0]), rng.choice([0.0, 0.4, 1.0]))
    x0, x1, y0, y1 = (1 - t) * start + t * end
    e, f, d = x1 - x0, y1 - y0, (1 - s) * x0 + s * x1 - (1 - r) * y0 - r * y1
    normal = np.cross(e, f) if m == 3 else np.array([-f[1], f[0]])
    gap = rng.choice([0.0, 1e-9, -1e-9, 1e-12]) * normal / np.linalg.norm(normal)
    shift = np.stack([d - gap, d - gap, 0 * d, 0 * d])
    return start - shift, end - shift


def slide(rng: Rng, m: int) -> Motion:
    """Parallel strands 1e-9 apart that slide along each other, or turn together, or collide."""
    start = np.zeros((4, m))
    start[:, 0] = [0.0, 1.0, rng.uniform(0.5, 2.0), rng.uniform(-1.0, 0.4)]
    start[2:, 1] = 1e-9
    end = start.copy()
    end[2:, 0] += rng.normal()
    end[2:, 1] *= rng.choice([1.0, 3.0, -1.0])
    turn = np.linalg.qr(rng.normal(size=(m, m)))[0]
    if rng.random() < 0.5:
        start = start @ turn
    return start, end @ turn


def short_edges(rng: Rng, m: int) -> Motion:
    """One edge 1e3 to 1e6 times as long as the other."""
    start, end = graze(rng, m)
    ratio = 10.0 ** -rng.integers(3, 7)
    start[1] = start[0] + ratio * (start[1] - start[0])
    end[1] = end[0] + ratio * (end[1] - end[0])
    return start, end


def slow(rng: Rng, m: int) -> Motion:
    """Vertices that hardly move, from near contact."""
    start, end = graze(rng, m)
    middle = 0.5 * (start + end)
    return middle, middle + 1e-6 * (end - start)


def spinning(rng: Rng, m: int) -> Motion:
    """Two crossed rods that turn a lot while they approach a little."""
    start = np.zeros((4, m))
    angle = rng.uniform(0.0, np.pi, size=2)
    for k, a in enumerate(angle):
        rod = np.zeros(m)
        rod[:2] = np.cos(a), np.sin(a)
        start[2 * k : 2 * k + 2] = [rod, -rod]
    start[:2, -1] += rng.choice([0.1, 0.01, 1e-3])
    end = start[[2, 3, 1, 0]] * rng.uniform(0.5, 1.0)
    end[:2, -1] += rng.choice([0.0, 1e-3, -1e-3])
    return start, end


KINDS: tuple[Callable[[Rng, int], Motion], ...] = (gaussian, lattice, graze, slide, short_edges, slow, spinning)


def placed(rng: Rng, motion: Motion) -> Motion:
    """The same in other units, and perhaps far from the origin."""
    scale = rng.choice([1.0, 1e-6, 1e6])
    offset = rng.choice([0.0, 0.0, 1e3]) * scale * rng.normal(size=motion[0].shape[1])
    return motion[0] * scale + offset, motion[1] * scale + offset
