"""Where strands turn in diagrams that are only told by what they pass, over and under: Gauss codes without signs.

If every crossing is smoothed so that one closed curve is left, that curve is simple, and touches itself where crossings
were: from inside or from outside.  Chords that join these places do not cross if they are drawn on their sides, so the
sides are the two colours of a graph (Dehn 1936; Rosenstiehl and Read, *Ann. Discrete Math.* 3, 1978).
"""

from collections.abc import Sequence
from dataclasses import dataclass

from ..errors import CurveError
from .diagram import Diagram, Pass
from .faces import Faces

_End = tuple[int, bool]  # where a strand meets a crossing: the pass, and whether there it goes out
_NOT_PLANAR = "the code is of no diagram in the plane"


@dataclass(frozen=True)
class _Visit:
    """The curve comes to a crossing by one end and leaves it by another."""

    crossing: int
    come: _End
    leave: _End

    @property
    def back(self) -> "_Visit":
        return _Visit(self.crossing, self.leave, self.come)


def realized(passes: Sequence[Sequence[Pass]]) -> Diagram:
    """The diagram of a Gauss code without signs, up to a mirror image, of which its first crossing is positive.

    Parameters
    ----------
    passes
        As in `Diagram`; each crossing is passed once above and once below.

    Raises
    ------
    CurveError
        If there is no such diagram in the plane, or there are several that are of different types.
    """
    count = sum(map(len, passes)) // 2
    whole = Diagram(tuple(map(tuple, passes)), (1,) * count)
    if sum(bool(piece.crossings) for piece in whole.pieces()) > 1:
        raise CurveError("the code falls apart into parts that share no crossing; give each by itself")
    if not count:
        return whole
    visits = _simple_curve(whole)
    left, groups = _sides(visits, count)
    signs = [0] * count
    for crossing, (first, second) in enumerate(_pairs(visits, count)):
        around = [visits[first].come, visits[first].leave, visits[second].come, visits[second].leave]
        if around[0][0] != around[2][0]:
            raise CurveError(_NOT_PLANAR)
        lower, upper = whole.strands[crossing]
        right = around[(around.index((lower, False)) + (1 if left[crossing] else 3)) % 4]
        signs[crossing] = 1 if right == (upper, True) else -1
    diagram = Diagram(whole.passes, tuple(sign * signs[0] for sign in signs))
    if not Faces(diagram).is_planar:
        raise CurveError(_NOT_PLANAR)
    if groups > 1:
        raise CurveError(
            "the code is of a composite knot or link, whose parts it leaves free to be mirror images; give a PD code"
        )
    return diagram


def _simple_curve(diagram: Diagram) -> list[_Visit]:
    """Smooth one crossing after the other so that components join, and none falls in two."""
    curves: list[list[_Visit]] = []
    i = 0
    for part in filter(None, diagram.passes):
        curves.append([_Visit(c, (i + k, False), (i + k, True)) for k, (c, _) in enumerate(part)])
        i += len(part)
    for crossing in range(diagram.crossings):
        one, *other = [curve for curve in curves if any(visit.crossing == crossing for visit in curve)]
        if other:
            curves = [curve for curve in curves if curve is not one and curve is not other[0]]
            curves.append(_joined(_from(one, crossing), _from(other[0], crossing)))
        else:
            curves[curves.index(one)] = _turned(_from(one, crossing))
    return curves[0]


def _from(curve: list[_Visit], crossing: int) -> list[_Visit]:
    """The same closed curve from its first visit of a crossing on."""
    start = next(k for k, visit in enumerate(curve) if visit.crossing == crossing)
    return curve[start:] + curve[:start]


def _joined(one: list[_Visit], other: list[_Visit]) -> list[_Visit]:
    a, b = one[0], other[0]
    return [_Visit(a.crossing, a.come, b.leave), *other[1:], _Visit(a.crossing, b.come, a.leave), *one[1:]]


def _turned(curve: list[_Visit]) -> list[_Visit]:
    """One of the loops at the first visit's crossing run through the other way."""
    again = next(k for k in range(1, len(curve)) if curve[k].crossing == curve[0].crossing)
    a, b = curve[0], curve[again]
    loop = [visit.back for visit in curve[again - 1 : 0 : -1]]
    return [_Visit(a.crossing, a.come, b.come), *loop, _Visit(a.crossing, a.leave, b.leave), *curve[again + 1 :]]


def _pairs(visits: list[_Visit], count: int) -> list[list[int]]:
    """For each crossing the places of both its visits."""
    places: list[list[int]] = [[] for _ in range(count)]
    for k, visit in enumerate(visits):
        places[visit.crossing].append(k)
    return places


def _sides(visits: list[_Visit], count: int) -> tuple[list[bool], int]:
    """Whether each crossing's chord lies on the left of the curve, chords that cross on different sides.

    Also how many groups of chords that cross there are, each of which might as well change sides.
    """
    chords = _pairs(visits, count)
    side: dict[int, bool] = {}
    several = 0
    for start in range(count):
        waiting = [] if start in side else [start]
        side.setdefault(start, True)
        known = len(side)
        while waiting:
            here = waiting.pop()
            a, b = chords[here]
            for other in {visit.crossing for visit in visits[a + 1 : b]}:
                if (a < chords[other][0] < b) == (a < chords[other][1] < b):
                    continue
                if other not in side:
                    side[other] = not side[here]
                    waiting.append(other)
                elif side[other] == side[here]:
                    raise CurveError(_NOT_PLANAR)
        several += len(side) > known
    return [side[crossing] for crossing in range(count)], several
