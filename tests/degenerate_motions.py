"""Motions of two segments aimed at the branches of the exact decisions: nothing about them is in general position.

Coordinates are small whole numbers or dyadic fractions, so two segments that miss each other do so clearly.
"""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Motion = tuple[Array, Array]  # x₀, x₁, y₀, y₁ at times 0 and 1, shapes (4, m)
Rng = np.random.Generator

END = 2.0**-20
# Where roots are told apart: the ends and the halvings of (−2⁻²⁰, 1], and numbers just outside [0, 1]
HALVINGS = (-END, 1.0, 0.5 - END / 2, 0.25 - 3 * END / 4, 0.75 - END / 4)
TIMES = (*HALVINGS, 0.0, 0.5, 1 + END, -(2.0**-30), 1 + 2.0**-30, -0.5)


def _whole(rng: Rng, *shape: int, size: int = 4) -> Array:
    return rng.integers(-size, size + 1, size=shape).astype(np.float64)


def _dimension(rng: Rng) -> int:
    return int(rng.choice([2, 3, 3]))


def _vanishing(rng: Rng, points: Array) -> Motion:
    """Coordinates proportional to t − τ, for a time τ where roots are told apart."""
    tau = rng.choice(TIMES)
    return -tau * points, (1 - tau) * points


def _sheared(rng: Rng, motion: Motion) -> Motion:
    """The same motion in other coordinates, and seen from a point that moves along."""
    m = motion[0].shape[1]
    turn = np.triu(_whole(rng, m, m, size=2), 1) + np.eye(m)
    turn = (turn @ (np.tril(_whole(rng, m, m, size=2), -1) + np.eye(m)))[:, rng.permutation(m)]
    drift = _whole(rng, 2, m)
    return motion[0] @ turn + drift[0], motion[1] @ turn + drift[1]


def collinear_once(rng: Rng) -> Motion:
    """All on one line at time τ: the volume has a double root there, |e × f|² too."""
    across = _vanishing(rng, _whole(rng, 4, 2, size=8))
    along = _whole(rng, 2, 4, 1, size=12)
    return _sheared(rng, (np.hstack([along[0], across[0]]), np.hstack([along[1], across[1]])))


def crossing_shadows(rng: Rng) -> Motion:
    """Two edges that meet although all is on one line at time τ.

    Seen along that line they always cross at the same place s, r of theirs; there one is above the other at first and
    below it in the end, so they meet.
    """
    while True:
        x0, x1, y0, y1 = shadow = _whole(rng, 4, 2, size=8)
        sides = [_side(y1 - y0, x0 - y0), _side(y1 - y0, x1 - y0), _side(x1 - x0, y0 - x0), _side(x1 - x0, y1 - x0)]
        if sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0:
            break
    s, r = sides[0] / (sides[0] - sides[1]), sides[2] / (sides[2] - sides[3])
    while True:
        height = _whole(rng, 2, 4, size=12)
        first, last = height @ [1 - s, s, r - 1, -r]
        if first * last < -1e-9:
            break
    across = _vanishing(rng, shadow)
    return np.column_stack([height[0], across[0]]), np.column_stack([height[1], across[1]])


def _side(direction: Array, point: Array) -> float:
    return float(direction[0] * point[1] - direction[1] * point[0])


def coplanar_once(rng: Rng) -> Motion:
    """All in one plane at time τ."""
    across = _vanishing(rng, _whole(rng, 4, 1, size=8))
    inside = _whole(rng, 2, 4, 2)
    return _sheared(rng, (np.hstack([inside[0], across[0]]), np.hstack([inside[1], across[1]])))


def one_point_once(rng: Rng) -> Motion:
    """All in one point at time τ, where everything has a multiple root."""
    return _sheared(rng, _vanishing(rng, _whole(rng, 4, _dimension(rng))))


def ends_at(rng: Rng) -> Motion:
    """An end comes to a point of the other edge, or to its line, at time τ."""
    m = _dimension(rng)
    start, end = _whole(rng, 2, 4, m)
    tau, r = rng.choice(TIMES), rng.choice([0.0, 0.25, 1.0, 1.25])
    x, y0, y1 = ((1 - tau) * p + tau * q for p, q in zip(start[[0, 2, 3]], end[[0, 2, 3]], strict=True))
    shift = (1 - r) * y0 + r * y1 - x
    keep = rng.integers(2)
    start[: 2 - keep] += shift
    end[: 2 - keep] += shift
    return start, end


def always_coplanar(rng: Rng) -> Motion:
    """In a plane that moves, or in the plane."""
    if rng.random() < 0.3:
        return _whole(rng, 4, 2), _whole(rng, 4, 2)
    flat = np.zeros((2, 4, 3))
    flat[:, :, :2] = _whole(rng, 2, 4, 2)
    return _sheared(rng, (flat[0], flat[1]))


def always_collinear(rng: Rng) -> Motion:
    """On a line that moves; edges grow, shrink and turn round."""
    m = _dimension(rng)
    line = np.zeros((2, 4, m))
    line[:, :, 0] = _whole(rng, 2, 4)
    return _sheared(rng, (line[0], line[1]))


def parallel(rng: Rng) -> Motion:
    """Edges that stay parallel, some of no length."""
    m = _dimension(rng)
    starts = _whole(rng, 2, 2, m)
    direction = _whole(rng, 2, m, size=2)
    factors = _whole(rng, 2, 2, size=2)
    ends = starts + factors[:, :, None] * direction[:, None]
    frames = np.stack([starts, ends], axis=2).reshape(2, 4, m)
    return frames[0], frames[1]


def points(rng: Rng) -> Motion:
    """One or both edges have no length."""
    start, end = _whole(rng, 2, 4, _dimension(rng), size=2)
    for frame in (start, end):
        frame[1] = frame[0]
    if rng.random() < 0.5:
        start[3], end[3] = start[2], end[2]
    return start, end


def lattice(rng: Rng) -> Motion:
    """Corners on a very small lattice."""
    start, end = _whole(rng, 2, 4, _dimension(rng), size=int(rng.integers(1, 4)))
    return start, end


def standing(rng: Rng) -> Motion:
    """A frame that does not move, or one edge of which moves along itself."""
    start = _whole(rng, 4, _dimension(rng), size=2)
    end = start.copy()
    if rng.random() < 0.5:
        end[:2] += rng.integers(-3, 4) * (start[1] - start[0])
    return start, end


ALWAYS = (always_coplanar, always_collinear, parallel, points, lattice, standing)
KINDS = (collinear_once, coplanar_once, one_point_once, ends_at, *ALWAYS)

ARCS = 32  # more than a tree has roots: boxes above the leaves hold two edges each


def tied_windows(rng: Rng) -> Motion:
    """Arcs of two vertices, shape (2 ARCS, 3), the first and the third of which go through each other.

    To the last bit or two, the boxes of these arcs meet when the larger boxes do that hold their neighbours too, and
    when the fastest vertex has moved by a mean edge length, up to which time a search may look for contacts first.
    """
    before, after, smaller = _tie(rng)
    start = np.zeros((ARCS, 2, 3))
    start[0, :, 1] = -0.001, 0.001
    start[1, :, 0], start[1, :, 1] = before - smaller, (-0.021, -0.02)
    start[2:4, :, 0], start[2:4, :, 2], start[3, :, 1] = before, (-0.01, 0.01), 0.02
    end = start.copy()
    end[:4, :, 0] = np.array([after, after / 2, 0.0, before / 2])[:, None]
    speed = np.reshape(end - start, (-1, 3)).T
    fastest = np.abs(speed - speed.mean(axis=1, keepdims=True)).max()
    # The other arcs stand apart, and make the mean length what it must be.
    meeting = rng.choice([before / (before + after), 1 / (1 + after / before)])
    length = fastest * (meeting * (1 - 16 * np.finfo(float).eps))
    k = np.arange(4, ARCS)[:, None]
    start[4:, :, 0], start[4:, :, 1] = -0.3 - 0.02 * k, -0.3 - 0.02 * (k % 4)
    start[4:, :, 2] = -0.9, length * ARCS / (ARCS - 4) - 0.9
    for _ in range(4):
        start[-1, 1, 2] += ARCS * (length - np.linalg.norm(start[:, 1] - start[:, 0], axis=1).mean())
    end[4:] = start[4:]
    scale = 2.0 ** rng.integers(-30, 30)
    return scale * start.reshape(-1, 3), scale * end.reshape(-1, 3)


def _tie(rng: Rng) -> tuple[float, float, float]:
    """Sizes of a gap before and after it closes, and a smaller one before, of which the rounded quotient is larger."""
    while True:
        before, after = rng.uniform(0.2, 0.6), rng.uniform(0.3, 0.9)
        smaller = before - rng.integers(1, 4) * np.spacing(before / 2)
        if smaller / (smaller + after) > before / (before + after):
            return before, after, smaller
