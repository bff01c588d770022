"""Sort out what of a rope is certainly as it must be during a leg, in floating-point numbers with error bounds."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import repeat

import numpy as np

from ..base import FloatArray, IntArray
from .checker import Polygons
from .planes import doubtful, overlapping

SLACK = 1e-12  # relative to the size of coordinates and lengths, far above their rounding


def crowded(
    start: FloatArray, end: FloatArray, polygons: Polygons, radius: Sequence[float], triangles: FloatArray
) -> Iterator[tuple[int, int, int | None]]:
    """Yield what of a rope is not proved: tails of edges, twice for their corners, or ends of one and a triangle.

    Vertices, shape (n, m), as for `doubtful_pairs`.  See `checker.RopeLeg` for what is to be proved.
    """
    heads, closed = np.array(polygons.heads), np.array(polygons.closed)
    part = np.repeat(np.arange(len(radius)), [len(each) for each in polygons.parts])  # the component of each vertex
    n = len(start)
    exponent = -int(np.frexp(max(np.abs(start).max(), np.abs(end).max(), np.abs(triangles).max(initial=0.0)))[1])
    start, end, still = (np.ldexp(x, exponent) for x in (start, end, triangles.reshape(-1, 3)))
    if start.shape[1] == 2:
        start, end = (np.pad(x, ((0, 0), (0, 1))) for x in (start, end))
    tails = np.flatnonzero(heads != np.arange(n))
    number = np.full(n, -1)
    number[tails] = np.arange(len(tails))
    c = part[tails]
    r = np.ldexp(np.array(radius), exponent)[c] * (1.0 + SLACK) + SLACK
    spans = np.stack([p[heads[tails]] - p[tails] for p in (start, end)])
    own = np.einsum("tem,tem->te", spans, spans)
    longest = np.sqrt(own.max(axis=0)) * (1.0 + SLACK) + SLACK

    needed, shortest, saved = _corners(spans, number[heads[tails]], longest)
    sharp = tails[r * needed * (1.0 + SLACK) > shortest - SLACK]
    yield from zip(sharp.tolist(), sharp.tolist(), repeat(None))
    position = np.cumsum(longest - r * saved) - longest
    around = np.where(closed, np.bincount(c, longest - r * saved, len(radius)), np.inf)

    ends = np.stack([start[tails], end[tails], start[heads[tails]], end[heads[tails]]])
    low, high = ends.min(axis=0) - r[:, None], ends.max(axis=0) + r[:, None]
    for pairs in overlapping((low, high)):
        i, j = np.sort(pairs, axis=0)
        half = np.pi * r[i] * (1.0 - SLACK)
        ways = np.stack([position[j] - position[i] - longest[i], around[c[i]] - position[j] - longest[j] + position[i]])
        ways[:, c[i] != c[j]] = np.inf  # all of their points count
        # those of neighbours always stay apart
        counts = (heads[tails[i]] != tails[j]) & (heads[tails[j]] != tails[i])
        counts &= (ways + longest[i] + longest[j] >= half).all(axis=0)
        i, j, half, ways = i[counts], j[counts], half[counts], ways[:, counts]
        whole = (ways >= half).all(axis=0)
        a, b = i[whole], j[whole]
        corners = np.stack([tails[a], heads[tails[a]], tails[b], heads[tails[b]]])
        left = doubtful(start, end, corners, 0.0, r[a] + r[b])
        yield from zip(left[0].tolist(), left[2].tolist(), repeat(None))
        # of the others parts, whose ends are points of their own
        i, j, half, ways = i[~whole], j[~whole], half[~whole], ways[:, ~whole]
        for steps in (4, 16):  # the last as `checker.RopeLeg` has
            back, rest, k = ways[1] < ways[0], half - ways.min(axis=0), np.arange(steps)[:, None]
            u = rest * (1.0 - (k + 1) / steps) / longest[i]
            v, w = rest * k / steps / longest[j], np.where(k + 1 == steps, 1.0, rest * (k + 1) / steps / longest[j])
            pair = np.broadcast_to(np.arange(len(i)), u.shape)[there := (u <= 1.0) & (v <= 1.0)]
            u, v, w = u[there] * (1.0 - SLACK), v[there] * (1.0 - SLACK), np.minimum(w[there] * (1.0 + SLACK), 1.0)
            a, b, back = i[pair], j[pair], back[pair]
            shares = [(a, np.where(back, u, 1.0 - u)), (a, 1.0 * back)]
            shares += [(b, np.where(back, 1.0 - s, s)) for s in (v, w)]
            points = [
                np.concatenate([p[tails[k]] + s[:, None] * d[k] for k, s in shares])
                for p, d in zip((start, end), spans, strict=True)
            ]
            left = doubtful(points[0], points[1], np.arange(4 * len(pair)).reshape(4, -1), 0.0, 2.0 * r[a])
            left = np.unique(pair[left[0]])
            i, j, half, ways = i[left], j[left], half[left], ways[:, left]
        yield from zip(tails[i].tolist(), tails[j].tolist(), repeat(None))

    if len(still):
        moving = [np.concatenate([p, still]) for p in (start, end)]
        boxes = still.reshape(-1, 3, 3).min(axis=1), still.reshape(-1, 3, 3).max(axis=1)
        for i, t in overlapping((low, high), boxes):
            corners = np.stack([tails[i], heads[tails[i]], *(n + 3 * t + k for k in range(3))])
            left = doubtful(moving[0], moving[1], corners, 0.0, r[i])
            yield from zip(left[0].tolist(), left[1].tolist(), ((left[2] - n) // 3).tolist(), strict=True)


def _corners(spans: FloatArray, after: IntArray, longest: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of edges: the sum of tan(θ/2) at both ends at most, the length at least, and 2 tan(θ/2) − θ at the tail at least.

    ``spans``, shape (2, edges, 3), are the edges at both times, ``after`` the number of the edge after each, or −1.
    Quadratic polynomials in time are between their coefficients in Bernstein's basis.
    """

    def between(product: Callable[..., FloatArray], u: FloatArray, v: FloatArray) -> FloatArray:
        return np.stack([product(u[0], v[0]), 0.5 * (product(u[0], v[1]) + product(u[1], v[0])), product(u[1], v[1])])

    inner, corner = partial(np.einsum, "em,em->e"), np.flatnonzero(after >= 0)
    e, f, sizes = spans[:, corner], spans[:, after[corner]], longest[corner] * longest[after[corner]]
    normals, cosines = between(np.cross, e, f), between(inner, e, f)
    shortest = np.sqrt(np.maximum(between(inner, spans, spans).min(axis=0), 0.0)) * (1.0 - SLACK)
    below = shortest[corner] * shortest[after[corner]] + cosines.min(axis=0)
    most = np.sqrt((normals * normals).sum(axis=2).max(axis=0)) / np.maximum(below, 1e-300) + SLACK
    most[below <= SLACK * sizes] = np.inf
    needed, saved = np.zeros_like(longest), np.zeros_like(longest)
    needed[corner] = most
    needed[after[corner]] += most

    middle = normals[1] / np.maximum(np.linalg.norm(normals[1], axis=1), 1e-300)[:, None]
    least = np.einsum("tem,em->te", normals, middle).min(axis=0)
    x = least / np.maximum(sizes + cosines.max(axis=0), 1e-300)
    x = np.maximum(x * (1.0 - SLACK) - SLACK, 0.0)
    y = 1.0 / np.maximum(x, 1.0)
    arc = x**3 / (3.0 + 1.8 * x**2), x - 1.5708 + y - y**3 / 3.0 + y**5 / 5.0 - y**7 / 7.0
    saved[after[corner]] = 2.0 * np.maximum(*arc)
    return needed, shortest, saved
