"""The regions that a diagram cuts the sphere into."""

from functools import cached_property

from .diagram import Diagram


class Faces:
    """For each edge of a diagram the regions on its left and on its right.

    Parameters
    ----------
    diagram
        Any signed Gauss code; see `is_planar`.

    Attributes
    ----------
    left, right
        Numbers of the regions at each edge.
    count
        How many regions there are.
    """

    def __init__(self, diagram: Diagram) -> None:
        self._diagram = diagram
        edges = len(diagram.sequence)
        self._root = list(range(2 * edges))  # side 2i is the left of edge i, 2i + 1 its right
        for around in diagram.rotations():
            for (a, leaves), (b, also) in zip(around, (*around[1:], around[0]), strict=True):
                self._join(2 * a + (not leaves), 2 * b + also)
        number: dict[int, int] = {}
        sides = [number.setdefault(self._find(side), len(number)) for side in range(2 * edges)]
        self.left, self.right, self.count = sides[::2], sides[1::2], len(number)

    def _find(self, side: int) -> int:
        while self._root[side] != side:
            self._root[side] = self._root[self._root[side]]
            side = self._root[side]
        return side

    def _join(self, a: int, b: int) -> None:
        self._root[self._find(a)] = self._find(b)

    @property
    def is_planar(self) -> bool:
        """Whether the code is of a diagram on the sphere: Euler's formula holds for each piece."""
        pieces = sum(bool(piece.crossings) for piece in self._diagram.pieces())
        return self.count == self._diagram.crossings + 2 * pieces

    @cached_property
    def borders(self) -> list[list[tuple[int, bool, int]]]:
        """For each region its edges, whether it lies on their left, and the region on the other side."""
        found: list[list[tuple[int, bool, int]]] = [[] for _ in range(self.count)]
        for edge, (left, right) in enumerate(zip(self.left, self.right, strict=True)):
            found[left].append((edge, True, right))
            found[right].append((edge, False, left))
        return found
