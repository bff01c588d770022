"""Moves of whole strands: one that only passes over (or under) others may take any other way over (under) them.

Reidemeister's first two moves are the shortest of these.  Those that remove crossings undo, in some view or
other, all the famous hard diagrams of the unknot, which Reidemeister's moves do not.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .diagram import Diagram, Pass
from .faces import Faces

_Step = tuple[int, bool]  # an edge that is crossed, and whether from its left


@dataclass(frozen=True)
class _Strand:
    """A run of passes that are all over, or all under; edge ``first`` leads to it, edge ``last`` away from it."""

    inner: Sequence[int]
    first: int
    over: bool

    @property
    def last(self) -> int:
        return self.inner[-1]

    @property
    def edges(self) -> set[int]:
        """All that is taken away with the strand."""
        return {self.first, *self.inner}


def shortened(diagram: Diagram) -> Diagram | None:
    """The diagram with one strand taken another way with fewer crossings; None if there is no such strand."""
    faces = Faces(diagram)
    for strand in sorted(_strands(diagram), key=lambda strand: -len(strand.inner)):
        way = _shortest_way(faces, strand, len(strand.inner))
        if way is not None:
            return _moved(diagram, strand, way)
    return None


def shuffled(diagram: Diagram, rng: np.random.Generator) -> Diagram:
    """The diagram with a piece of a strand, chosen at random, taken any other way with as many crossings."""
    strands = list(_strands(diagram))
    strand = strands[rng.integers(len(strands))]
    begin, end = np.sort(rng.choice(len(strand.inner) + 1, size=2, replace=False))
    inner = strand.inner[begin:end]
    piece = _Strand(inner, diagram.previous[inner[0]], strand.over)
    way = _shortest_way(Faces(diagram), piece, len(inner) + 1, rng)
    return diagram if way is None else _moved(diagram, piece, way)


def _strands(diagram: Diagram) -> Iterator[_Strand]:
    """The longest runs of passes over, or under."""
    sequence, start = diagram.sequence, 0
    for part in diagram.passes:
        levels = [over for _, over in part]
        turns = [k for k in range(len(part)) if levels[k] != levels[k - 1]] or [0] * bool(part)
        for k, begin in enumerate(turns):
            length = (turns[(k + 1) % len(turns)] - begin - 1) % len(part) + 1
            inner = [start + (begin + step) % len(part) for step in range(length)]
            yield _Strand(inner, diagram.previous[inner[0]], sequence[inner[0]][1])
        start += len(part)


def _shortest_way(
    faces: Faces, strand: _Strand, bound: int, rng: np.random.Generator | None = None
) -> list[_Step] | None:
    """The edges that the strand crosses on a shortest way, fewer than the bound; None if there is no such way.

    A breadth-first search among the regions, in random order if asked for; edges that go with the strand cost nothing.
    """
    own, start, goal = strand.edges, faces.left[strand.first], faces.left[strand.last]
    came: dict[int, tuple[int, _Step | None]] = {start: (start, None)}
    distance, waiting = {start: 0}, deque([start])
    while waiting:
        here = waiting.popleft()
        if here == goal:
            return _steps(came, here)
        borders = faces.borders[here]
        for k in range(len(borders)) if rng is None else rng.permutation(len(borders)):
            edge, from_left, there = borders[k]
            cost = distance[here] + (edge not in own)
            if cost < distance.get(there, bound):
                distance[there] = cost
                came[there] = here, None if edge in own else (edge, from_left)
                (waiting.appendleft if edge in own else waiting.append)(there)
    return None


def _steps(came: dict[int, tuple[int, _Step | None]], here: int) -> list[_Step]:
    steps = []
    while came[here][0] != here:
        here, step = came[here]
        if step is not None:
            steps.append(step)
    return steps[::-1]


def _moved(diagram: Diagram, strand: _Strand, way: Sequence[_Step]) -> Diagram:
    """The diagram with the strand on another way."""
    gone = {diagram.sequence[i][0] for i in strand.inner}
    new = range(diagram.crossings, diagram.crossings + len(way))
    after: dict[int, list[Pass]] = {edge: [(c, not strand.over)] for c, (edge, _) in zip(new, way, strict=True)}
    after[strand.first] = [(c, strand.over) for c in new]
    passes: list[tuple[Pass, ...]] = []
    i = 0
    for part in diagram.passes:
        rest: list[Pass] = []
        for each in part:
            rest += [each, *after.get(i, [])]
            i += 1
        passes.append(tuple(rest))
    # A strand that crosses over another one from its left is the upper strand of a positive crossing.
    signs = (1 if from_left == strand.over else -1 for _, from_left in way)
    return Diagram(tuple(passes), (*diagram.signs, *signs)).without(gone)
