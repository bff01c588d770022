"""Diagrams with fewer crossings, by moves that keep the type, and the factors of sums that they show.

One of whole strands that only pass over (or under) others may take any other route over (under) them: Reidemeister's
first two moves are the shortest of these.  Those that remove crossings undo, in some view or other, all the famous hard
diagrams of the unknot, which Reidemeister's moves do not.  How long this takes is bounded by counts, never by clocks.
"""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .diagram import ENDS, Diagram, Pass


class Strand(NamedTuple):
    """A run of passes that are all over, or all under, from edge ``first`` to the edge after its last pass."""

    inner: Sequence[int]
    first: int
    over: bool


@dataclass(frozen=True)
class StrandMove:
    """A strand of a diagram rerouted: ``route`` are the darts that it crosses from the left from now on."""

    before: Diagram
    strand: Strand
    route: Sequence[int]

    @cached_property
    def after(self) -> Diagram:
        diagram, strand = self.before, self.strand
        removed = {diagram.sequence[i][0] for i in strand.inner}
        new = range(diagram.crossings, diagram.crossings + len(self.route))
        after: dict[int, list[Pass]] = {d // 2: [(c, not strand.over)] for c, d in zip(new, self.route, strict=True)}
        after[strand.first] = [(c, strand.over) for c in new]
        passes: list[list[Pass]] = [[] for _ in diagram.passes]
        for i, each in enumerate(diagram.sequence):
            passes[diagram.component[i]] += [each, *after.get(i, [])]
        # A strand that crosses over another one from its left is the upper strand of a positive crossing.
        signs = (1 if (dart % 2 == 0) == strand.over else -1 for dart in self.route)
        return Diagram(tuple(map(tuple, passes)), (*diagram.signs, *signs)).without(removed)

    @property
    def saved(self) -> int:
        """How many crossings go."""
        return len(self.strand.inner) - len(self.route)


def shortened(diagram: Diagram) -> StrandMove | None:
    """Reroute the longest strand that can cross fewer edges; None if there is none."""
    return next(shortenings(diagram), None)


def shortenings(diagram: Diagram, rng: np.random.Generator | None = None) -> Iterator[StrandMove]:
    """All strands that can cross fewer edges rerouted across fewest, the longest ones first, or in random order."""
    every = sorted(strands(diagram), key=lambda strand: -len(strand.inner))
    for k in range(len(every)) if rng is None else rng.permutation(len(every)):
        route = shortest_route(diagram, every[k], len(every[k].inner))
        if route is not None:
            yield StrandMove(diagram, every[k], route)


def shuffled(diagram: Diagram, rng: np.random.Generator) -> StrandMove | None:
    """Reroute a piece of a strand, chosen at random, across as many edges; None if there is no route."""
    every = list(strands(diagram))
    strand = every[rng.integers(len(every))]
    begin, end = np.sort(rng.choice(len(strand.inner) + 1, size=2, replace=False))
    inner = strand.inner[begin:end]
    piece = Strand(inner, diagram.previous[inner[0]], strand.over)
    route = shortest_route(diagram, piece, len(inner) + 1, rng)
    return None if route is None else StrandMove(diagram, piece, route)


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


def simplified(diagram: Diagram, work: int = 400_000) -> Diagram:
    """Remove crossings while a move of a single strand does so, and no more than ``work`` crossings are visited."""
    for fewer in simplifying(diagram):
        if work <= 0:
            return fewer
        work -= fewer.crossings
    return fewer


def simplifying(diagram: Diagram) -> Iterator[Diagram]:
    """Yield diagrams of fewer and fewer crossings, each by a move of a single strand, to one where no move helps."""
    yield (diagram := reduced(diagram))
    while move := shortened(diagram):
        yield (diagram := reduced(move.after))


def shuffled_down(diagram: Diagram, enough: Callable[[Diagram], bool]) -> Diagram:
    """Move strands at random until crossings can be removed, again and again.

    Ends at a diagram that is simple ``enough``, after 150 moves in a row that removed none, or at once if there are
    more than 60 crossings, which random moves hardly improve.
    """
    rng, vain, trial = np.random.default_rng(20219), 0, diagram
    while vain < 150 and diagram.crossings <= 60 and not enough(diagram):
        # some diagrams have no way on: every now and then it begins anew
        trial, vain = trial if vain % 20 else diagram, vain + 1
        move = shuffled(trial, rng)
        trial = trial if move is None else simplified(move.after)
        if trial.crossings < diagram.crossings:
            diagram, vain = trial, 0
    return diagram


def rearranged(diagram: Diagram, rng: np.random.Generator, moves: int = 10) -> Diagram:
    """Another diagram of few crossings: all strands that can cross fewer edges are moved, in random order.

    Then moves across as many edges follow, and of all that are seen the last one of fewest crossings is taken.
    """
    least = diagram = reduced(diagram)
    for _ in range(moves if diagram.crossings else 0):
        while shorter := next(shortenings(diagram, rng), None):
            diagram = reduced(shorter.after)
        if diagram.crossings <= least.crossings:
            least = diagram
        if not diagram.crossings:
            break
        other = shuffled(diagram, rng)
        diagram = diagram if other is None else reduced(other.after)
    return least


def is_least(diagram: Diagram) -> bool:
    """Whether no diagram has fewer crossings than a simplified one: there are none, or over and under alternate.

    That is so for closed components (Kauffman, Murasugi, Thistlethwaite 1987), whatever places are held.
    """
    levels = [[over for crossing, over in part if crossing >= 0] for part in diagram.passes]
    alternates = all(part[k - 1] != part[k] for part in levels for k in range(len(part)))
    return not diagram.crossings or (alternates and ENDS not in diagram.sequence)


def reduced(diagram: Diagram) -> Diagram:
    """Undo loops (Reidemeister I) and bigons of one strand over another (II) until there are none."""
    following, before = list(diagram.next), list(diagram.previous)  # linked lists, from which passes are taken out
    sequence, removed = diagram.sequence, set[int]()
    waiting = list(range(len(sequence)))
    while waiting:
        i = waiting.pop()
        j = following[i]
        (a, over), (b, also) = sequence[i], sequence[j]
        if a in removed or min(a, b) < 0:
            continue
        x, y = diagram.levels[a][not over], diagram.levels[b][not over]
        # Where the signs are equal both crossings are nugatory: what is between them and the rest meet in each alone.
        if a != b and not (over == also and (following[x] == y or following[y] == x)):
            continue
        for crossing in {a, b}:
            removed.add(crossing)
            for k in diagram.levels[crossing]:
                following[before[k]], before[following[k]] = following[k], before[k]
                waiting.append(before[k])
    return diagram.without(removed)


def without_nugatory(diagram: Diagram) -> Diagram:
    """The diagram without nugatory crossings, at which a face meets itself; turning over one side undoes them.

    Leaving one out of the code makes a connected sum, in one component, of the two sides, which is what it was.
    """
    while found := {c for c, darts in enumerate(diagram.darts) if len({diagram.face_of[d] for d in darts}) < 4}:
        diagram = diagram.without(found)
    return diagram


def factors(piece: Diagram) -> list[Diagram]:
    """The summands of a simplified connected diagram, those without crossings left out unless there is no other.

    Circles that meet the diagram in two points, on edges with the same faces, cut it into factors.
    """
    seen: dict[frozenset[int], int] = {}
    for edge in range(len(piece.sequence)):
        sides = frozenset((piece.face_of[2 * edge], piece.face_of[2 * edge + 1]))
        other = seen.setdefault(sides, edge)
        if other != edge and piece.component[other] == piece.component[edge]:
            # the passes after one edge up to the other become a component of their own
            k = piece.component[other]
            start, part = piece.component.index(k), piece.passes[k]
            a, b = other - start + 1, edge - start + 1
            cut = replace(piece, passes=(*piece.passes[:k], part[:a] + part[b:], part[a:b], *piece.passes[k + 1 :]))
            return [factor for part in cut.pieces() for factor in factors(part)]
    return [piece]
