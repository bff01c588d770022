"""Boxes that overlap, and fixed planes that keep moving edges apart, in floating-point numbers with error bounds."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from ..base import FloatArray, IntArray
from ..base.tolerances import SIEVE_ROUNDING, SIEVE_UNDERFLOW

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
            yield really_overlapping(first, other, *((j, i) if swapped else (i, j)))


def really_overlapping(first: Boxes, second: Boxes, i: IntArray, j: IntArray) -> tuple[IntArray, IntArray]:
    for axis in range(first[0].shape[1]):
        keep = (first[0][i, axis] <= second[1][j, axis]) & (second[0][j, axis] <= first[1][i, axis])
        i, j = i[keep], j[keep]
    return i, j


def doubtful(
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
        for kind, k, other in SEGMENT_PLANES if len(vertices) == 4 else TRIANGLE_PLANES:
            if not left.size:
                return vertices[:, left]
            here, along = differences[:, :, left], edges[:, :, left]
            t = 0.5 * (a + b)[:, None]
            # the direction of the plane halfway, pointing from y to x
            chords, spans = ((1 - t) * p[0] + t * p[1] for p in (here, along))
            if kind == "chord":
                normal = chords.sum(axis=0)
            elif kind == "ends":
                normal = chords[k]
            elif kind == "line":
                c, e = chords[k], spans[other]
                part = np.einsum("pm,pm->p", c, e) / np.maximum(np.einsum("pm,pm->p", e, e), np.finfo(np.float64).tiny)
                normal = c - part[:, None] * e
            elif chords.shape[-1] == 2:  # no vector product
                normal = np.zeros_like(chords[0])
            else:
                normal = np.cross(spans[k], spans[other])
                normal *= np.sign(np.einsum("pm,pm->p", normal, chords.sum(axis=0)))[:, None]
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
