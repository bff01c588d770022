"""Diagrams from what is passed over and under alone: the signs of crossings that make it a diagram in the plane."""

from collections.abc import Sequence
from typing import NamedTuple

from ...base import CurveError
from .diagram import Diagram, Pass

_End = tuple[int, bool]  # where the curve meets a crossing: the pass, and whether there it goes out
_NOT_PLANAR = "the code has no planar diagram"


def in_the_plane(diagram: Diagram, what: str) -> Diagram:
    """The diagram; a CurveError if it is none on the sphere, in which the code is called ``what``."""
    if not diagram.is_planar:
        raise CurveError(f"{what} has no planar diagram")
    return diagram


class _Visit(NamedTuple):
    """The smoothed curve comes to a crossing by one end and leaves it by another."""

    crossing: int
    come: _End
    leave: _End


def realized(passes: Sequence[Sequence[Pass]]) -> Diagram:
    """The diagram of a Gauss code without signs, up to a mirror image, of which its first crossing is positive.

    If every crossing is smoothed so that one closed curve is left, that curve is simple, and touches itself where
    crossings were: from inside or from outside.  Chords that join these places do not cross if they are drawn on their
    sides, so the sides are the two colors of a graph (Dehn 1936; Rosenstiehl and Read, *Ann. Discrete Math.* 3, 1978).

    ``passes`` are as in `Diagram`; each crossing is passed once above and once below.  Raises CurveError if there is no
    such diagram in the plane, or there are several that are of different types.
    """
    count = sum(map(len, passes)) // 2
    whole = Diagram(tuple(map(tuple, passes)), (1,) * count)
    if sum(bool(piece.crossings) for piece in whole.pieces()) > 1:
        raise CurveError("the code falls apart into parts that share no crossing; give each by itself")
    if not count:
        return whole
    # crossings are smoothed one after the other so that components join, and none falls in two
    visits = [_Visit(c, (i, False), (i, True)) for i, (c, _) in enumerate(whole.sequence)]
    curves = [[visits[i] for i, k in enumerate(whole.component) if k == part] for part in set(whole.component)]
    for crossing in range(whole.crossings):
        places = [(curve, k) for curve in curves for k, visit in enumerate(curve) if visit.crossing == crossing]
        (one, i), (other, j) = places
        a, b = one[i], other[j]
        rest = [*one[i + 1 :], *one[:i]]
        if one is other:  # one of the loops at the crossing is run through the other way
            loop = [_Visit(visit.crossing, visit.leave, visit.come) for visit in one[j - 1 : i : -1]]
            smooth = [_Visit(crossing, a.come, b.come), *loop, _Visit(crossing, a.leave, b.leave), *rest[j - i :]]
        else:
            tour = [*other[j + 1 :], *other[:j]]
            smooth = [_Visit(crossing, a.come, b.leave), *tour, _Visit(crossing, b.come, a.leave), *rest]
        curves = [curve for curve in curves if curve is not one and curve is not other] + [smooth]
    visits = curves[0]
    chords: list[list[int]] = [[] for _ in range(count)]  # from visit to visit of each crossing
    for k, visit in enumerate(visits):
        chords[visit.crossing].append(k)
    # on which side of the curve chords are; in each group of crossing chords all may change sides
    side: dict[int, bool] = {}
    groups = 0
    for start in range(len(chords)):
        waiting = [] if start in side else [start]
        side.setdefault(start, True)
        known = len(side)
        while waiting:
            here = waiting.pop()
            first, second = chords[here]
            for there in {visit.crossing for visit in visits[first + 1 : second]}:
                if (first < chords[there][0] < second) == (first < chords[there][1] < second):
                    continue
                if there not in side:
                    side[there] = not side[here]
                    waiting.append(there)
                elif side[there] == side[here]:
                    raise CurveError(_NOT_PLANAR)
        groups += len(side) > known
    signs = []
    for crossing, (first, second) in enumerate(chords):
        around = [visits[first].come, visits[first].leave, visits[second].come, visits[second].leave]
        if around[0][0] != around[2][0]:
            raise CurveError(_NOT_PLANAR)
        lower, upper = whole.levels[crossing]
        right = around[(around.index((lower, False)) + (1 if side[crossing] else 3)) % 4]
        signs.append(1 if right == (upper, True) else -1)
    diagram = Diagram(whole.passes, tuple(sign * signs[0] for sign in signs))
    in_the_plane(diagram, "the code")
    if groups > 1:
        raise CurveError(
            "the code is of a composite knot or link, whose parts it leaves free to be mirror images; give a PD code"
        )
    return diagram
