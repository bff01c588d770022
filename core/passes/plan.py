"""Sequences of strand moves on the diagram alone, where trying again costs next to nothing."""

from collections.abc import Callable, Iterator

import numpy as np

from ..deadline import check_time
from ..diagrams.diagram import ENDS, Diagram
from ..diagrams.rerouting import Move, shortened, shortenings, shuffled

_RANDOM = 2  # descents with moves chosen at random, beside those with the longest strands and the best savings
_LENGTHS = 1, 2, 4, 8, 16, 32, 64  # shuffles in a row,
_TRIALS = 30  # so many times each
_WORK = 100_000  # crossings of all diagrams that are shuffled on the way to one with fewer

Policy = Callable[[Diagram, np.random.Generator], Move | None]


def planned(diagram: Diagram, rng: np.random.Generator, *, shuffles: bool = True, settled: bool = True) -> list[Move]:
    """Moves, one after the other, to a diagram with fewer crossings; none if none are found.

    Parameters
    ----------
    diagram
        With places where it is held, perhaps.
    rng
        Chooses among moves.
    shuffles
        Whether to begin with moves that save nothing where none saves anything.
    settled
        Whether the moves that look best are among those tried; else all are random.
    """
    policies = ([_longest, _best] if settled else []) + [_any] * _RANDOM
    moves = min((descended(diagram, policy, rng) for policy in policies), key=_cost)
    return _through_shuffles(diagram, rng) if shuffles and not moves and not is_least(diagram) else moves


def is_least(diagram: Diagram) -> bool:
    """Whether it is known that no diagram has fewer crossings: there are none, or over and under alternate.

    The latter only counts for closed components of diagrams without nugatory crossings, which moves of strands remove.
    """
    rest = [[over for crossing, over in part if crossing >= 0] for part in diagram.passes]
    alternating = all(part[k - 1] != part[k] for part in rest for k in range(len(part)))
    return not diagram.crossings or (alternating and ENDS not in diagram.sequence and shortened(diagram) is None)


def _cost(moves: list[Move]) -> tuple[int, int]:
    """What is left, and how long it takes."""
    return -sum(move.saved for move in moves), len(moves)


def _longest(diagram: Diagram, rng: np.random.Generator) -> Move | None:
    return shortened(diagram)


def _best(diagram: Diagram, rng: np.random.Generator) -> Move | None:
    return max(shortenings(diagram), key=lambda move: move.saved, default=None)


def _any(diagram: Diagram, rng: np.random.Generator) -> Move | None:
    return next(shortenings(diagram, rng), None)


def descended(diagram: Diagram, policy: Policy, rng: np.random.Generator) -> list[Move]:
    """Moves that save crossings, until none does."""
    moves: list[Move] = []
    while (move := policy(diagram, rng)) is not None:
        moves.append(move)
        diagram = move.after
    return moves


def _through_shuffles(diagram: Diagram, rng: np.random.Generator) -> list[Move]:
    """As few moves that save nothing as possible until one saves crossings, and what follows; none if that fails."""
    work = 0
    for length in (length for length in _LENGTHS for _ in range(_TRIALS)):
        check_time()
        moves: list[Move] = []
        here = diagram
        for move in _shuffles(diagram, length, rng):
            moves.append(move)
            here = move.after
            if shortened(here) is not None:
                return [*moves, *descended(here, _best, rng)]
        work += length * diagram.crossings
        if work > _WORK:
            break
    return []


def _shuffles(diagram: Diagram, length: int, rng: np.random.Generator) -> Iterator[Move]:
    """At most so many moves that change the diagram, and not the number of crossings."""
    for _ in range(length):
        move = shuffled(diagram, rng)
        if move is not None and not _returns(move):
            yield move
            diagram = move.after


def _returns(move: Move) -> bool:
    """Whether a way crosses the same strands at the same places as before."""
    before = move.before
    partners = [before.levels[before.sequence[i][0]][not move.strand.over] for i in move.strand.inner]
    return len(partners) == len(move.route) and all(
        dart // 2 in (pass_, before.previous[pass_]) for dart, pass_ in zip(move.route, partners, strict=True)
    )
