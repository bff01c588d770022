"""Moves of whole strands: one that only passes over (or under) others may take any other route over (under) them.

Reidemeister's first two moves are the shortest of these.  Those that remove crossings undo, in some view or
other, all the famous hard diagrams of the unknot, which Reidemeister's moves do not.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .diagram import Diagram, Pass


class Strand(NamedTuple):
    """A run of passes that are all over, or all under, from edge ``first`` to the edge after its last pass."""

    inner: Sequence[int]
    first: int
    over: bool


@dataclass(frozen=True)
class Move:
    """A strand of a diagram rerouted: ``route`` are the darts that it crosses from the left from now on."""

    before: Diagram
    strand: Strand
    route: Sequence[int]

    @cached_property
    def after(self) -> Diagram:
        """The diagram that results."""
        return rerouted(self.before, self.strand, self.route)

    @property
    def saved(self) -> int:
        """How many crossings go."""
        return len(self.strand.inner) - len(self.route)


def shortened(diagram: Diagram) -> Move | None:
    """Reroute the longest strand that can cross fewer edges; None if there is none."""
    return next(shortenings(diagram), None)


def shortenings(diagram: Diagram, rng: np.random.Generator | None = None) -> Iterator[Move]:
    """All strands that can cross fewer edges rerouted across fewest, the longest ones first, or in random order."""
    every = sorted(strands(diagram), key=lambda strand: -len(strand.inner))
    for k in range(len(every)) if rng is None else rng.permutation(len(every)):
        route = shortest_route(diagram, every[k], len(every[k].inner))
        if route is not None:
            yield Move(diagram, every[k], route)


def shuffled(diagram: Diagram, rng: np.random.Generator) -> Move | None:
    """Reroute a piece of a strand, chosen at random, across as many edges; None if there is no route."""
    every = list(strands(diagram))
    strand = every[rng.integers(len(every))]
    begin, end = np.sort(rng.choice(len(strand.inner) + 1, size=2, replace=False))
    inner = strand.inner[begin:end]
    piece = Strand(inner, diagram.previous[inner[0]], strand.over)
    route = shortest_route(diagram, piece, len(inner) + 1, rng)
    return None if route is None else Move(diagram, piece, route)


def strands(diagram: Diagram) -> Iterator[Strand]:
    """The longest runs of passes over, or under, between places where the curve is held."""
    start = 0
    for part in diagram.passes:
        levels = [over if crossing >= 0 else None for crossing, over in part]
        turns = [k for k in range(len(part)) if levels[k] is None or levels[k] != levels[k - 1]] or [0] * bool(part)
        for k, begin in enumerate(turns):
            if levels[begin] is None:
                continue
            length = (turns[(k + 1) % len(turns)] - begin - 1) % len(part) + 1
            inner = [start + (begin + step) % len(part) for step in range(length)]
            yield Strand(inner, diagram.previous[inner[0]], part[begin][1])
        start += len(part)


def shortest_route(
    diagram: Diagram, strand: Strand, bound: int, rng: np.random.Generator | None = None
) -> list[int] | None:
    """The darts that the strand crosses from the left on a shortest route, fewer than the bound; None if there is none.

    A breadth-first search among the faces, in random order if asked for; edges that go with the strand cost nothing.
    """
    own, face_of = {strand.first, *strand.inner}, diagram.face_of
    start, goal = face_of[2 * strand.first], face_of[2 * strand.inner[-1]]
    came: dict[int, int] = {}  # the dart that was crossed into each face
    distance, waiting = {start: 0}, deque([start])
    while waiting:
        here = waiting.popleft()
        if here == goal:
            break
        border = sorted(diagram.faces[here])
        for dart in border if rng is None else rng.permutation(border).tolist():
            free, there = dart // 2 in own, face_of[dart ^ 1]
            cost = distance[here] + (not free)
            if cost < distance.get(there, bound):
                distance[there], came[there] = cost, dart
                (waiting.appendleft if free else waiting.append)(there)
    else:
        return None
    route = []
    while here != start:
        route.append(came[here])
        here = face_of[came[here]]
    return [dart for dart in route[::-1] if dart // 2 not in own]


def rerouted(diagram: Diagram, strand: Strand, route: Sequence[int]) -> Diagram:
    """The diagram with the strand on another route, given by the darts that it crosses from the left."""
    gone = {diagram.sequence[i][0] for i in strand.inner}
    new = range(diagram.crossings, diagram.crossings + len(route))
    after: dict[int, list[Pass]] = {dart // 2: [(c, not strand.over)] for c, dart in zip(new, route, strict=True)}
    after[strand.first] = [(c, strand.over) for c in new]
    passes: list[list[Pass]] = [[] for _ in diagram.passes]
    for i, each in enumerate(diagram.sequence):
        passes[diagram.component[i]] += [each, *after.get(i, [])]
    # A strand that crosses over another one from its left is the upper strand of a positive crossing.
    signs = (1 if (dart % 2 == 0) == strand.over else -1 for dart in route)
    return Diagram(tuple(map(tuple, passes)), (*diagram.signs, *signs)).without(gone)
