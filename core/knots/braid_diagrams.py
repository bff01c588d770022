"""Diagrams of closed braids, from their words alone."""

from collections.abc import Sequence

from ..diagrams.diagram import Diagram, Pass
from .braids import checked_word, cycles, permutation


def braid_diagram(word: Sequence[int]) -> Diagram:
    """The closure of a braid as the word draws it; raises as `checked_word` does.

    Examples
    --------
    >>> braid_diagram([1, 1]).linking_numbers
    (1,)
    """
    letters, strands = checked_word(word)
    passes: list[list[Pass]] = [[] for _ in range(strands)]
    at = list(range(strands))
    for crossing, letter in enumerate(letters):
        place = abs(letter) - 1
        passes[at[place]].append((crossing, letter > 0))  # in a positive crossing the one that moves outwards is over
        passes[at[place + 1]].append((crossing, letter < 0))
        at[place], at[place + 1] = at[place + 1], at[place]
    parts = (
        tuple(each for strand in cycle for each in passes[strand]) for cycle in cycles(permutation(letters, strands))
    )
    return Diagram(tuple(parts), tuple(1 if letter > 0 else -1 for letter in letters))
