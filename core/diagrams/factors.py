"""Connected sums that a diagram shows: circles that meet it in two points cut it into factors."""

from dataclasses import replace

from .diagram import Diagram
from .faces import Faces


def factors(piece: Diagram) -> list[Diagram]:
    """The summands of a link whose diagram hangs together, those without crossings left out unless there is no other.

    Parameters
    ----------
    piece
        A connected diagram, simplified, so that no summand is a mere kink.
    """
    cut = _cut(piece)
    if cut is None:
        return [piece]
    return [factor for part in cut.pieces() for factor in factors(part)]


def _cut(piece: Diagram) -> Diagram | None:
    """The diagram cut along a circle through two edges, and the ends on both sides joined; None if there is none."""
    faces, seen = Faces(piece), dict[frozenset[int], int]()
    for edge in range(len(piece.sequence)):
        sides = frozenset((faces.left[edge], faces.right[edge]))
        other = seen.setdefault(sides, edge)
        if other != edge and piece.component[other] == piece.component[edge]:
            return _rejoined(piece, other, edge)
    return None


def _rejoined(piece: Diagram, first: int, second: int) -> Diagram:
    """The passes after one edge up to another of the same component made a component of their own."""
    k = piece.component[first]
    start = piece.component.index(k)
    part = piece.passes[k]
    a, b = first - start + 1, second - start + 1
    return replace(piece, passes=(*piece.passes[:k], part[:a] + part[b:], part[a:b], *piece.passes[k + 1 :]))
