"""Sort out pairs that certainly do not meet during a leg, in floating-point numbers with error bounds."""

from collections.abc import Iterator, Sequence
from itertools import chain, combinations, repeat

import numpy as np

from ..base.tolerances import SIEVE_ROUNDING, SIEVE_UNDERFLOW
from ..base.types import BoolArray, FloatArray, IntArray
from .checker import Points, Polygons

Boxes = tuple[FloatArray, FloatArray]  # least and largest coordinates, each (k, m)

# Directions of planes that may separate x₀x₁ from y, by the numbers of differences x_i − y_j of ends and of edges: the
# chord, which is the sum of all differences, the vector product of two edges, from an edge's line to an end of the
# other, and from end to end.
SEGMENT_PLANES = (
    ("chord", 0, 0),
    ("across", 0, 1),
    *(("line", end, edge) for end, edge in ((0, 1), (2, 1), (0, 0), (1, 0))),
    *(("ends", end, 0) for end in range(4)),
)
# differences x₀y₀, x₀y₁, x₀y₂, x₁y₀, x₁y₁, x₁y₂; edges e, y₁ − y₀, y₂ − y₀, y₂ − y₁
TRIANGLE_PLANES = (
    ("across", 1, 2),
    ("chord", 0, 0),
    *(("across", 0, edge) for edge in (1, 2, 3)),
    *(("line", end, edge) for end, edge in ((0, 1), (0, 2), (1, 3), (3, 1), (3, 2), (4, 3), (0, 0), (1, 0), (2, 0))),
    *(("ends", end, 0) for end in range(6)),
)


class FloatingSieve:
    """The pairs on a leg that the checker must decide: what it asks instead of `checker.Nearby`."""

    def __init__(self, triangles: Sequence[Points]) -> None:
        self.triangles = np.array(triangles, dtype=np.float64).reshape(-1, 3, 3)
        self._last: tuple[Points, FloatArray] = [], np.empty((0, 3))  # each leg begins where the one before ends

    def __call__(self, start: Points, end: Points, polygons: Polygons, clearance: float) -> Iterator[tuple[int, ...]]:
        """Yield x₀, x₁, y₀, y₁ of pairs of edges, and x₀, x₁ and the triangle's number; see `checker.Nearby`."""
        before, after = map(self._rows, (start, end))
        for batch in doubtful_pairs(before, after, np.array(polygons.heads), clearance, self.triangles):
            yield from zip(*batch.tolist(), strict=True)

    def crowded(
        self, start: Points, end: Points, polygons: Polygons, radius: Sequence[float]
    ) -> Iterator[tuple[int, int, int | None]]:
        """Yield what of a rope must be decided; see `checker.Nearby`."""
        part = np.repeat(np.arange(len(radius)), [len(each) for each in polygons.parts])
        heads, closed = np.array(polygons.heads), np.array(polygons.closed)
        frames = map(self._rows, (start, end))
        yield from crowded(*frames, heads, part, closed, np.array(radius), self.triangles)

    def _rows(self, points: Points) -> FloatArray:
        if self._last[0] is not points:
            self._last = points, np.fromiter(chain.from_iterable(points), np.float64).reshape(len(points), -1)
        return self._last[1]


def doubtful_pairs(
    start: FloatArray, end: FloatArray, heads: IntArray, clearance: float = 0.0, triangles: FloatArray | None = None
) -> Iterator[IntArray]:
    """Yield the pairs of edges, and of edges and triangles, that are not proved apart as vertices go from start to end.

    Non-neighbour edges; in closed polygons of three edges, which have none of these, each vertex, as an edge of no
    length, with the opposite edge; and each end of an open polygon with the edge after its neighbour.  Start and end
    are vertices, shape (n, m) with m = 2 or 3; ``heads``, shape (n,), is the vertex that the edge from each vertex
    leads to: the vertex itself where an open polygon ends.  Triangles, shape (k, 3, 3), are at rest.  Pairs stay apart
    even if every coordinate of every vertex is wrong by the clearance.

    Yields the vertices x₀, x₁, y₀, y₁ of a bounded number of pairs, shape (4, pairs), or x₀, x₁ and the triangle.
    """
    n = len(start)
    if triangles is not None and len(triangles):  # their corners come after the vertices
        start, end = (np.concatenate([points, triangles.reshape(-1, 3)]) for points in (start, end))
    exponent = -int(np.frexp(max(np.abs(start).max(), np.abs(end).max()))[1])  # coordinates are at most 1 in size
    start, end = np.ldexp(start, exponent), np.ldexp(end, exponent)
    if clearance:
        clearance = max(float(np.ldexp(clearance, exponent)), SIEVE_UNDERFLOW)
    for vertices in _nearby(start, end, heads, clearance):
        if (kept := _doubtful(start, end, vertices, clearance)).size:
            yield kept if len(kept) == 4 else np.stack([*kept[:2], (kept[2] - n) // 3])


def crowded(
    start: FloatArray,
    end: FloatArray,
    heads: IntArray,
    part: IntArray,
    closed: BoolArray,
    radius: FloatArray,
    triangles: FloatArray,
) -> Iterator[tuple[int, int, int | None]]:
    """Yield what of a rope is not proved: tails of edges, twice for their corners, or ends of one and a triangle.

    Vertices, shape (n, m), as for `doubtful_pairs`; the component of each vertex, and whether it is closed and its
    radius, shape (components,).  See `checker.RopeLeg` for what is to be proved.
    """
    slack, steps, n = 1e-12, 16, len(start)
    exponent = -int(np.frexp(max(np.abs(start).max(), np.abs(end).max(), np.abs(triangles).max(initial=0.0)))[1])
    start, end, still = (np.ldexp(x, exponent) for x in (start, end, triangles.reshape(-1, 3)))
    if start.shape[1] == 2:
        start, end = (np.pad(x, ((0, 0), (0, 1))) for x in (start, end))
    tails = np.flatnonzero(heads != np.arange(n))
    number = np.full(n, -1)
    number[tails] = np.arange(len(tails))
    c = part[tails]
    r = np.ldexp(radius, exponent)[c] * (1.0 + slack) + slack
    spans = np.stack([p[heads[tails]] - p[tails] for p in (start, end)])
    own = np.einsum("tem,tem->te", spans, spans)
    longest = np.sqrt(own.max(axis=0)) * (1.0 + slack) + slack

    # corners: quadratic polynomials in time are between their coefficients in Bernstein's basis
    after = number[heads[tails]]
    corner = np.flatnonzero(after >= 0)
    e, f = spans[:, corner], spans[:, after[corner]]
    vector = np.stack([np.cross(e[0], f[0]), 0.5 * (np.cross(e[0], f[1]) + np.cross(e[1], f[0])), np.cross(e[1], f[1])])
    dots = [
        np.stack([(u[0] * v[0]).sum(1), 0.5 * ((u[0] * v[1]).sum(1) + (u[1] * v[0]).sum(1)), (u[1] * v[1]).sum(1)])
        for u, v in ((e, f), (spans, spans))
    ]
    shortest = np.sqrt(np.maximum(dots[1].min(axis=0), 0.0)) * (1.0 - slack)
    sizes = shortest[corner] * shortest[after[corner]] + dots[0].min(axis=0)
    most = np.sqrt((vector * vector).sum(axis=2).max(axis=0)) / np.maximum(sizes, 1e-300) + slack
    most[sizes <= slack * longest[corner] * longest[after[corner]]] = np.inf
    needed = np.zeros(len(tails))
    np.add.at(needed, corner, most)
    np.add.at(needed, after[corner], most)
    sharp = tails[r * needed * (1.0 + slack) > shortest - slack]
    yield from zip(sharp.tolist(), sharp.tolist(), repeat(None))

    # what arcs save on the way round corners, at least
    middle = vector[1] / np.maximum(np.linalg.norm(vector[1], axis=1), 1e-300)[:, None]
    least = np.einsum("tem,em->te", vector, middle).min(axis=0)
    x = least / np.maximum(longest[corner] * longest[after[corner]] + dots[0].max(axis=0), 1e-300)
    x = np.maximum(x * (1.0 - slack) - slack, 0.0)
    y = 1.0 / np.maximum(x, 1.0)
    arc = x**3 / (3.0 + 1.8 * x**2), x - 1.5708 + y - y**3 / 3.0 + y**5 / 5.0 - y**7 / 7.0
    saved = np.zeros(len(tails))
    saved[after[corner]] = 2.0 * r[corner] * np.maximum(*arc)
    position = np.cumsum(longest - saved) - longest
    around = np.where(closed, np.bincount(c, longest - saved, len(radius)), np.inf)

    ends = np.stack([start[tails], end[tails], start[heads[tails]], end[heads[tails]]])
    low, high = ends.min(axis=0) - r[:, None], ends.max(axis=0) + r[:, None]
    for pairs in overlapping((low, high)):
        i, j = np.sort(pairs, axis=0)
        half = np.where(c[i] == c[j], np.pi * r[i] * (1.0 - slack), 0.0)
        ways = np.stack([position[j] - position[i] - longest[i], around[c[i]] - position[j] - longest[j] + position[i]])
        counts = (ways + longest[i] + longest[j] >= half).all(axis=0)
        i, j, half, ways = i[counts], j[counts], half[counts], ways[:, counts]
        whole = (ways >= half).all(axis=0)
        a, b = i[whole], j[whole]
        corners = np.stack([tails[a], heads[tails[a]], tails[b], heads[tails[b]]])
        left = _doubtful(start, end, corners, 0.0, r[a] + r[b])
        yield from zip(left[0].tolist(), left[2].tolist(), repeat(None))
        # of the others parts, whose ends are points of their own
        i, j, half, ways = i[~whole], j[~whole], half[~whole], ways[:, ~whole]
        back, k = ways[1] < ways[0], np.arange(steps)[:, None]
        rest = half - ways.min(axis=0)
        u = rest * (1.0 - (k + 1) / steps) / longest[i]
        v, w = rest * k / steps / longest[j], np.where(k + 1 == steps, 1.0, rest * (k + 1) / steps / longest[j])
        there = (u <= 1.0) & (v <= 1.0)
        i, j, back = (np.broadcast_to(each, there.shape)[there] for each in (i, j, back))
        u, v, w = u[there] * (1.0 - slack), v[there] * (1.0 - slack), np.minimum(w[there] * (1.0 + slack), 1.0)
        shares = (i, np.where(back, u, 1.0 - u)), (i, 1.0 * back), *((j, np.where(back, 1.0 - s, s)) for s in (v, w))
        points = [
            np.concatenate([p[tails[k]] + s[:, None] * d[k] for k, s in shares])
            for p, d in zip((start, end), spans, strict=True)
        ]
        names = np.stack([i, j])
        corners = np.arange(4 * len(i)).reshape(4, -1)
        left = _doubtful(*points, corners, 0.0, 2.0 * r[i])
        yield from zip(*tails[np.unique(names[:, left[0]], axis=1)].tolist(), repeat(None))

    if len(still):
        moving = [np.concatenate([p, still]) for p in (start, end)]
        boxes = still.reshape(-1, 3, 3).min(axis=1), still.reshape(-1, 3, 3).max(axis=1)
        for i, t in overlapping((low, high), boxes):
            corners = np.stack([tails[i], heads[tails[i]], *(n + 3 * t + k for k in range(3))])
            left = _doubtful(*moving, corners, 0.0, r[i])
            yield from zip(left[0].tolist(), left[1].tolist(), ((left[2] - n) // 3).tolist(), strict=True)


def _nearby(start: FloatArray, end: FloatArray, heads: IntArray, clearance: float) -> Iterator[IntArray]:
    """Vertices of pairs that may meet, as their boxes overlap; shapes (4 or 5, pairs).

    Ranges are compared and never divided, and rounding keeps the order of values scaled, lowered or raised: no
    overlapping pair is taken to be apart.
    """
    n, here = len(heads), np.arange(len(heads))
    # What must not meet although it is neighbours: each vertex of a triangle, twice, and the ends of the opposite edge;
    # each end of an open polygon, twice, and the two vertices after it, the same one if it is the last.
    before, tails = here.copy(), np.flatnonzero(heads != here)
    before[heads[tails]] = tails
    triangles = tails[heads[heads[heads[tails]]] == tails]
    folds = (triangles, heads), (np.flatnonzero(before == here), heads), (np.flatnonzero(heads == here), before)
    yield np.concatenate([np.stack([k, k, way[k], way[way[k]]]) for k, way in folds], axis=1)

    ends = np.stack([start[tails], end[tails], start[heads[tails]], end[heads[tails]]])
    low, high = ends.min(axis=0) - 4 * clearance, ends.max(axis=0) + 4 * clearance
    for i, j in overlapping((low, high)):
        i, j = tails[i], tails[j]
        keep = (heads[i] != j) & (heads[j] != i)
        i, j = i[keep], j[keep]
        yield np.stack([i, heads[i], j, heads[j]])

    corners = start[n:].reshape(-1, 3, start.shape[1])
    if not len(corners):
        return
    still = corners.min(axis=1), corners.max(axis=1)
    # runs of neighbouring edges, whose own box, made without rounding, overlaps all that theirs do, come first
    size = 16
    starts = np.arange(0, len(tails), size)
    runs = np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)
    for run, j in overlapping(runs, still):
        i, j = (size * run + np.arange(size)[:, None]).ravel(), np.tile(j, size)
        i, j = _really_overlapping((low, high), still, i[i < len(tails)], j[i < len(tails)])
        yield np.stack([tails[i], heads[tails[i]], *(n + 3 * j + k for k in range(3))])


def overlapping(first: Boxes, second: Boxes | None = None) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield pairs of overlapping boxes, of two kinds or of one, in batches, each pair once.

    Along the widest axis one of them begins within the other: of two of one kind the one that comes later in the order
    of their beginnings, of two of different kinds, that begin at the same place, the second.
    """
    other, at_once = second or first, 1 << 13
    axis = int(np.argmax(np.ptp(np.concatenate([first[0], other[0]]), axis=0)))
    for swapped in (False, True) if second else (False,):
        one, two = (other, first) if swapped else (first, other)
        order = np.argsort(two[0][:, axis], kind="stable")
        begin = two[0][order, axis]
        start = np.searchsorted(begin, one[0][:, axis], side="right" if swapped else "left")
        if second is None:
            start[order] = np.arange(1, len(order) + 1)
        total = np.cumsum([0, *np.maximum(np.searchsorted(begin, one[1][:, axis], side="right") - start, 0)])
        for k in range(0, int(total[-1]), at_once):
            position = np.arange(k, min(k + at_once, int(total[-1])))
            i = np.searchsorted(total, position, side="right") - 1
            j = order[start[i] + position - total[i]]
            yield _really_overlapping(first, other, *((j, i) if swapped else (i, j)))


def _really_overlapping(first: Boxes, second: Boxes, i: IntArray, j: IntArray) -> tuple[IntArray, IntArray]:
    for axis in range(first[0].shape[1]):
        keep = (first[0][i, axis] <= second[1][j, axis]) & (second[0][j, axis] <= first[1][i, axis])
        i, j = i[keep], j[keep]
    return i, j


def _doubtful(
    start: FloatArray, end: FloatArray, vertices: IntArray, clearance: float, distance: FloatArray | None = None
) -> IntArray:
    """The pairs of an edge x₀x₁ and an edge y₀y₁, or a triangle y₀y₁y₂, that are not proved apart during one leg.

    Start and end, shape (n, m), have entries of at most 1 in size; ``vertices``, shape (4 or 5, pairs), are x₀, x₁, y₀,
    y₁, and y₂ of triangles.  With a distance, shape (pairs,), they are to stay further apart than that.  Cheap tests
    come first; each looks only at what the one before has left over.
    """
    ends = np.stack([start, end])[:, vertices].swapaxes(0, 1)  # (4 or 5, 2, pairs, m)
    x, y, gap = ends[:2], ends[2:], 2.5 * clearance
    width = np.zeros(vertices.shape[1]) if distance is None else distance
    # x_i − y_j at both times: shape (2, 4 or 6, pairs, m); the vectors of x's edge, and of y's one or three
    differences = np.stack([p - q for p in x for q in y], axis=1)
    # one stays above the other along a coordinate axis
    room = gap + width[:, None]
    above = (differences > room).all(axis=(0, 1)) | (differences < -room).all(axis=(0, 1))
    left = np.flatnonzero(~np.any(above, axis=1))
    width = width[left]
    vertices, x, y, differences = vertices[:, left], x[:, :, left], y[:, :, left], differences[:, :, left]
    edges = np.stack([x[1] - x[0], *(q - p for p, q in combinations(y, 2))], axis=1)

    # fixed planes separate them, each for a part of the time [a, b], which is halved where none is found
    left = np.arange(len(left))
    a, b = np.zeros(len(left)), np.ones(len(left))
    for halvings in range(6):
        if halvings:
            middle = 0.5 * (a + b)
            left, a, b = np.tile(left, 2), np.concatenate([a, middle]), np.concatenate([middle, b])
        for plane in SEGMENT_PLANES if len(vertices) == 4 else TRIANGLE_PLANES:
            if not left.size:
                return vertices[:, left]
            here, along = differences[:, :, left], edges[:, :, left]
            t = 0.5 * (a + b)[:, None]
            normal = _normal(*plane, *((1 - t) * p[0] + t * p[1] for p in (here, along)))
            # whether ⟨n, x_i − y_j⟩, linear in time, is certainly positive at times a and b for all corners
            value = np.einsum("tcpm,pm->tcp", here, normal)
            error = SIEVE_ROUNDING * np.einsum("tcpm,pm->tcp", np.abs(here), np.abs(normal))
            value -= error + (gap * np.abs(normal).sum(axis=1) + SIEVE_UNDERFLOW)
            value -= width[left] * np.sqrt(np.einsum("pm,pm->p", normal, normal)) * (1.0 + SIEVE_ROUNDING)
            apart = [((1 - t) * value[0] + t * value[1] > 0).all(axis=0) for t in (a, b)]
            left, a, b = (each[~(apart[0] & apart[1])] for each in (left, a, b))
    left = np.unique(left)

    # det(D, e, f) of two edges has no zero in [0, 1]: all its Bernstein coefficients have one sign
    if left.size and clearance == 0.0 and distance is None and len(vertices) == 4 and start.shape[1] == 3:
        sums, errors = np.zeros((4, left.size)), np.full((4, left.size), SIEVE_UNDERFLOW)
        for p, q, r in np.ndindex(2, 2, 2):
            D, e, f = differences[p, 0, left], edges[q, 0, left], edges[r, 1, left]
            sums[p + q + r] += np.einsum("pm,pm->p", D, np.cross(e, f))
            u, v, w = np.abs(D), np.abs(e), np.abs(f)
            permanent = v[:, [1, 2, 0]] * w[:, [2, 0, 1]] + v[:, [2, 0, 1]] * w[:, [1, 2, 0]]
            errors[p + q + r] += SIEVE_ROUNDING * np.einsum("pm,pm->p", u, permanent)
        left = left[~((sums > errors).all(axis=0) | (sums < -errors).all(axis=0))]
    return vertices[:, left]


def _normal(kind: str, k: int, other: int, differences: FloatArray, edges: FloatArray) -> FloatArray:
    """The direction of a plane, see `SEGMENT_PLANES`, pointing from y to x; shape (pairs, m)."""
    if kind == "chord":
        return np.asarray(differences.sum(axis=0))
    if kind == "ends":
        return np.asarray(differences[k])
    if kind == "line":
        c, e = differences[k], edges[other]
        along = np.einsum("pm,pm->p", c, e) / np.maximum(np.einsum("pm,pm->p", e, e), np.finfo(np.float64).tiny)
        return np.asarray(c - along[:, None] * e)
    if differences.shape[-1] == 2:  # no vector product
        return np.zeros_like(differences[0])
    normal = np.cross(edges[k], edges[other])
    return np.asarray(normal * np.sign(np.einsum("pm,pm->p", normal, differences.sum(axis=0)))[:, None])
