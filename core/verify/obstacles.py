"""Triangles at rest, which the curve must not touch either, and the ones that an edge may touch during a leg.

A segment is a triangle two of whose vertices coincide.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Literal

import numpy as np

from ..types import FloatArray, IntArray
from .filter import Leg, scaled

_PAIRS_AT_ONCE = 1 << 12
_RUN = 16  # edges whose common box is tested first
Boxes = tuple[FloatArray, FloatArray]  # least and largest coordinates, each (k, 3)


@dataclass(frozen=True, eq=False)
class Obstacles:
    """All obstacles of a trajectory, together."""

    vertices: FloatArray  # of all obstacles, shape (k, 3)
    triangles: IntArray  # indices of the triangles' vertices, shape (f, 3)
    ends: tuple[int, ...]  # number of vertices up to the end of each obstacle

    @classmethod
    def of(cls, parts: Sequence[tuple[FloatArray, IntArray]]) -> "Obstacles":
        """Join obstacles, each given by its vertices and its faces, shapes (k, 3) and (f, 2 or 3)."""
        sizes = [len(vertices) for vertices, _ in parts]
        first = np.cumsum([0, *sizes])
        triangles = [faces[:, [0, 1, -1]] + k for (_, faces), k in zip(parts, first, strict=False)]
        return cls(
            np.concatenate([np.empty((0, 3)), *(vertices for vertices, _ in parts)]),
            np.concatenate([np.empty((0, 3), dtype=np.intp), *triangles]),
            tuple(first[1:].tolist()),
        )

    def __len__(self) -> int:
        return len(self.ends)

    def number_of(self, vertex: int) -> int:
        """The obstacle, counted from 0, that a vertex belongs to."""
        return int(np.searchsorted(self.ends, vertex, side="right"))

    @cached_property
    def boxes(self) -> Boxes:
        corners = self.vertices[self.triangles]
        return corners.min(axis=1), corners.max(axis=1)

    def doubtful(
        self, start: FloatArray, end: FloatArray, heads: IntArray, clearance: float = 0.0
    ) -> Iterator[IntArray]:
        """Yield the edges and triangles that are not proved apart while vertices go from start to end.

        Parameters are those of `filter.doubtful_pairs`. Yields x₀, x₁ among the curve's vertices and y₀, y₁, y₂ among
        the obstacles' for a bounded number of pairs, shape (5, pairs).
        """
        if not len(self.triangles):
            return
        n = len(start)
        both = np.concatenate([start, self.vertices]), np.concatenate([end, self.vertices])
        before, after, gap = scaled(*both, clearance)
        ends = np.stack([start, end, start[heads], end[heads]])
        edges = ends.min(axis=0) - 4 * clearance, ends.max(axis=0) + 4 * clearance
        for i, j in _boxes_that_overlap(edges, self.boxes):
            leg = Leg(before, after, np.concatenate([[i, heads[i]], n + self.triangles[j].T]), gap)
            leg.drop(leg.apart_along_axis)
            leg.drop(leg.apart_by_planes)
            if leg.vertices.size:
                yield leg.vertices - np.array([[0], [0], [n], [n], [n]])


def _boxes_that_overlap(first: Boxes, second: Boxes) -> Iterator[tuple[IntArray, IntArray]]:
    """`overlapping`, by runs of neighbouring boxes, whose own box, made without rounding, overlaps all that they do."""
    starts = np.arange(0, len(first[0]), _RUN)
    runs = np.minimum.reduceat(first[0], starts), np.maximum.reduceat(first[1], starts)
    for run, j in overlapping(runs, second):
        i = (_RUN * run + np.arange(_RUN)[:, None]).ravel()
        j = np.tile(j, _RUN)
        real = i < len(first[0])
        yield _kept(first, second, i[real], j[real])


def overlapping(first: Boxes, second: Boxes) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield pairs of overlapping boxes of two kinds in batches: along the widest axis one begins within the other."""
    axis = int(np.argmax(np.ptp(np.concatenate([first[0], second[0]]), axis=0)))
    ranges = [(low[:, axis], high[:, axis]) for low, high in (first, second)]
    of_second = _beginning_within(*ranges[0], ranges[1][0], "left")
    of_first = ((i, j) for j, i in _beginning_within(*ranges[1], ranges[0][0], "right"))
    for i, j in chain(of_second, of_first):
        yield _kept(first, second, i, j)


def _kept(first: Boxes, second: Boxes, i: IntArray, j: IntArray) -> tuple[IntArray, IntArray]:
    for axis in range(3):
        keep = (first[0][i, axis] <= second[1][j, axis]) & (second[0][j, axis] <= first[1][i, axis])
        i, j = i[keep], j[keep]
    return i, j


def _beginning_within(
    low: FloatArray, high: FloatArray, begin: FloatArray, side: Literal["left", "right"]
) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs of a range and another that begins in it; for ``side`` right not at its own beginning."""
    order = np.argsort(begin, kind="stable")
    first = np.searchsorted(begin[order], low, side=side)
    total = np.cumsum([0, *np.maximum(np.searchsorted(begin[order], high, side="right") - first, 0)])
    for k in range(0, int(total[-1]), _PAIRS_AT_ONCE):
        position = np.arange(k, min(k + _PAIRS_AT_ONCE, int(total[-1])))
        i = np.searchsorted(total, position, side="right") - 1
        yield i, order[first[i] + position - total[i]]
