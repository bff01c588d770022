"""Polygons that are proved to be ambient isotopic to smooth knots and links, by ball arithmetic (docs/bounds.md)."""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import combinations

from ..arguments import checked
from ..curve import Curve
from ..curve.fourier import FourierCurve
from ..errors import CurveError
from ..types import ComplexArray, FloatArray
from .balls import Loop, acb_mat, arb, floor, precise, separations

_SPARE = 1.1  # times the vertices that are about enough


@checked
def inscribed(coefficients: Sequence[ComplexArray]) -> Curve:
    """Inscribe a polygon in a smooth knot or link, at equal steps, which is proved to be ambient isotopic to it.

    ``coefficients`` has an array for each component, shape (modes + 1, 3), as in `FourierCurve`.  Raises CurveError
    where nothing is proved because the curve meets itself or has a cusp, or nearly so.
    """
    with precise():
        margins = _Margins(coefficients)
        polygon = FourierCurve(tuple(coefficients)).polygon(margins.sizes())
        if not margins.allow(polygon.components):
            raise CurveError(_REFUSAL)
    return polygon


@checked
def proves(coefficients: Sequence[ComplexArray], curve: Curve) -> bool:
    """Whether a polygon is proved to be ambient isotopic to a smooth knot or link, so that both have the same type.

    Vertex j of the n of a component must be near γ(j/n).  False, which proves nothing, for a polygon that is too coarse
    or another curve.  Raises CurveError as `inscribed` does.
    """
    with precise():
        margins = _Margins(coefficients)
        if curve.dimension != 3 or len(curve.components) != len(margins.loops) or not all(curve.mesh.closed):
            return False
        return margins.allow(curve.components)


_REFUSAL = "the curve meets itself or has a cusp, or nearly so: its type cannot be proved"


class _Margins:
    """How far a smooth link is from meeting itself, as bounds that are proved; CurveError where one is not positive.

    For each component the least speed v, an upper bound g of |γ''|, and c with |γ(s) − γ(t)| ≥ c |sin π(s − t)|;
    for two components their distance.
    """

    def __init__(self, coefficients: Sequence[ComplexArray]) -> None:
        self.loops = loops = [Loop(c) for c in coefficients]
        self.bends = [loop.majorant(2) for loop in loops]
        self.speeds = [_root(loop.speeds, loop.modes) for loop in loops]
        self.chords = [_root(partial(separations, loop, loop), loop.modes) for loop in loops]
        modes = max((loop.modes for loop in loops), default=0)
        pairs = combinations(range(len(loops)), 2)
        self.gaps = {(i, j): _root(partial(separations, loops[i], loops[j]), modes) for i, j in pairs}

    def sizes(self) -> list[int]:
        """Numbers of vertices, for each component, of an inscribed polygon that is near enough."""
        counts = []
        for i, (g, v, c) in enumerate(zip(self.bends, self.speeds, self.chords, strict=True)):
            gaps = [gap for pair, gap in self.gaps.items() if i in pair]
            least = [arb(3), g / v, (g**2 / (8 * c * v)).sqrt(), *((g / (4 * gap)).sqrt() for gap in gaps)]
            counts.append(math.ceil(_SPARE * max(map(float, least))))
        return counts

    def allow(self, parts: Sequence[FloatArray]) -> bool:
        """Whether polygons deviate so little that γ + τe, where e is the deviation, meets itself for no τ from 0 to 1.

        With n edges |e| ≤ g/(8n²) and |e'| ≤ g/(2n), and on top comes what the vertices are off.
        """
        sups = []
        for part, loop, g, v, c in zip(parts, self.loops, self.bends, self.speeds, self.chords, strict=True):
            n = len(part)
            off = [[x.real for x in row] for row in (acb_mat(part.tolist()) - loop.points(n)).tolist()]
            turns = [[y - x for x, y in zip(*ends, strict=True)] for ends in zip(off, off[1:] + off[:1], strict=True)]
            sup, slope = _longest(off) + g / (8 * n**2), n * _longest(turns) + g / (2 * n)
            if not slope + g * sup / (2 * c) < v:
                return False
            sups.append(sup)
        return all(sups[i] + sups[j] < gap for (i, j), gap in self.gaps.items())


def _longest(vectors: Sequence[Sequence[arb]]) -> arb:
    """An upper bound of the lengths of vectors."""
    longest = arb(0)
    for vector in vectors:
        longest = longest.max(sum((x * x for x in vector), arb(0)))
    return longest.upper().sqrt()


def _root(line: Callable[[float, int], Iterable[Sequence[arb]]], modes: int) -> arb:
    """A lower bound of the root of what is sampled on the real line."""
    square = floor(partial(line, 0.0), 2 * modes)
    if square is None:
        raise CurveError(_REFUSAL)
    return square.sqrt()
