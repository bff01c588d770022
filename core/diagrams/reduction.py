"""Reidemeister's first two moves, wherever they remove crossings, in time that grows with the number of passes."""

from .diagram import Diagram


def reduced(diagram: Diagram) -> Diagram:
    """Undo loops of one crossing and bigons of one strand over another, until there are none."""
    return diagram.without(_Passes(diagram).removed)


class _Passes:
    """Passes as linked lists, from which crossings are taken out."""

    def __init__(self, diagram: Diagram) -> None:
        self._diagram = diagram
        self._next, self._previous = list(diagram.next), list(diagram.previous)
        self.removed: set[int] = set()
        waiting = list(range(len(diagram.sequence)))
        while waiting:
            gone = self._undone(waiting.pop())
            for crossing in gone:
                waiting += self._take_out(crossing)

    def _undone(self, i: int) -> set[int]:
        """The crossings that a move on pass i and the next one removes."""
        sequence, j = self._diagram.sequence, self._next[i]
        (a, over), (b, also) = sequence[i], sequence[j]
        if a in self.removed:
            return set()
        if a == b:
            return {a}
        x, y = self._diagram.strands[a][not over], self._diagram.strands[b][not over]
        beside = self._next[x] == y or self._next[y] == x
        # Where the signs are equal both crossings are nugatory: what is between them and the rest meet in each alone.
        return {a, b} if over == also and beside else set()

    def _take_out(self, crossing: int) -> list[int]:
        """Unlink both passes, and return those before them, where new moves may begin."""
        self.removed.add(crossing)
        before = []
        for i in self._diagram.strands[crossing]:
            self._next[self._previous[i]], self._previous[self._next[i]] = self._next[i], self._previous[i]
            before.append(self._previous[i])
        return before
