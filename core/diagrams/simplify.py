"""Diagrams with fewer crossings, by moves that keep the type, and the factors of sums that they show.

How long this takes is bounded by counts, never by clocks.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .diagram import ENDS, Diagram
from .rerouting import shortened, shuffled


def simplified(diagram: Diagram, work: int = 400_000) -> Diagram:
    """Remove crossings while a move of a single strand does so, and no more than ``work`` crossings are visited."""
    diagram = reduced(diagram)
    while work > 0:
        work -= diagram.crossings
        fewer = shortened(diagram)
        if fewer is None:
            break
        diagram = reduced(fewer.after)
    return diagram


def shuffled_down(
    diagram: Diagram, enough: Callable[[Diagram], bool], *, seed: int = 20219, patience: int = 150, most: int = 60
) -> Diagram:
    """Move strands at random until crossings can be removed, again and again.

    Ends at a diagram that is simple ``enough``, after ``patience`` moves in a row that removed none, or at once if
    there are more than ``most`` crossings, which random moves hardly improve.
    """
    rng, vain, trial = np.random.default_rng(seed), 0, diagram
    while vain < patience and diagram.crossings <= most and not enough(diagram):
        move, vain = shuffled(trial, rng), vain + 1
        trial = trial if move is None else simplified(move.after)
        if trial.crossings < diagram.crossings:
            diagram, vain = trial, 0
    return diagram


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
            return [factor for part in _cut(piece, other, edge).pieces() for factor in factors(part)]
    return [piece]


def _cut(piece: Diagram, first: int, second: int) -> Diagram:
    """The passes after one edge up to another of the same component made a component of their own."""
    k = piece.component[first]
    start = piece.component.index(k)
    part = piece.passes[k]
    a, b = first - start + 1, second - start + 1
    return replace(piece, passes=(*piece.passes[:k], part[:a] + part[b:], part[a:b], *piece.passes[k + 1 :]))
