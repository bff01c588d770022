"""Diagrams with fewer crossings, by moves that keep the type; how long is told by counts, never by clocks."""

from collections.abc import Callable

import numpy as np

from .diagram import Diagram
from .reduction import reduced
from .rerouting import shortened, shuffled

_WORK = 400_000  # crossings looked at by moves that remove some, all in all: seconds
_SHUFFLES = 150  # random moves without any that removes crossings, after which a diagram is given up on
_FEW = 60  # crossings, of diagrams that random moves may still improve


def simplified(diagram: Diagram) -> Diagram:
    """Remove crossings while a move of a single strand does so; a diagram of thousands may keep some."""
    diagram, work = reduced(diagram), 0
    while work < _WORK:
        work += diagram.crossings
        fewer = shortened(diagram)
        if fewer is None:
            break
        diagram = reduced(fewer)
    return diagram


def shuffled_down(diagram: Diagram, enough: Callable[[Diagram], bool], seed: int = 20219) -> Diagram:
    """Move strands at random until crossings can be removed, again and again.

    Ends where there is ``enough`` done, or many moves in a row were in vain.
    """
    rng, vain, trial = np.random.default_rng(seed), 0, diagram
    while vain < _SHUFFLES and diagram.crossings <= _FEW and not enough(diagram):
        trial, vain = simplified(shuffled(trial, rng)), vain + 1
        if trial.crossings < diagram.crossings:
            diagram, vain = trial, 0
    return diagram


def is_least(diagram: Diagram) -> bool:
    """Whether no diagram has fewer crossings than this simplified one, which is so where over and under alternate.

    (Kauffman, Murasugi, Thistlethwaite 1987; moves of single strands leave no nugatory crossings.)
    """
    return all(part[k - 1][1] != part[k][1] for part in diagram.passes for k in range(len(part)))
