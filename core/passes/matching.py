"""The same diagram with its passes numbered otherwise."""

from ..diagrams.diagram import Diagram
from ..diagrams.rerouting import Move, Strand


def carried(move: Move, diagram: Diagram) -> Move | None:
    """A move of a diagram as one of another that is the same but for the numbers of passes; None if it is not."""
    number = _numbers(move.before, diagram)
    if number is None:
        return None
    inner, first, over = move.strand
    strand = Strand([number[i] for i in inner], number[first], over)
    return Move(diagram, strand, [2 * number[dart // 2] + dart % 2 for dart in move.route])


def _numbers(old: Diagram, new: Diagram) -> dict[int, int] | None:
    """For each pass of one diagram that of another, components in the same order; None if they are different."""
    if [len(part) for part in old.passes] != [len(part) for part in new.passes]:
        return None
    found: dict[int, int] = {}
    for begin in range(len(old.sequence)):
        if begin in found:
            continue
        candidates = (i for i, part in enumerate(new.component) if part == old.component[begin])
        more = next(filter(None, (_from(old, new, begin, i) for i in candidates)), None)
        if more is None:
            return None
        found |= more
    return found


def _from(old: Diagram, new: Diagram, begin: int, image: int) -> dict[int, int] | None:
    """The passes that can be reached from one along strands and at crossings, if its image is given."""
    found: dict[int, int] = {}
    waiting = [(begin, image)]
    while waiting:
        i, j = waiting.pop()
        if i in found:
            if found[i] != j:
                return None
            continue
        found[i] = j
        (c, over), (d, also) = old.sequence[i], new.sequence[j]
        if over != also or min(c, 0) != min(d, 0) or old.component[i] != new.component[j]:
            return None
        waiting.append((old.next[i], new.next[j]))
        if c >= 0:
            if old.signs[c] != new.signs[d]:
                return None
            waiting.append((old.levels[c][not over], new.levels[d][not over]))
    return found
