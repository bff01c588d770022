"""Invariants that cost little: values of Alexander polynomials and linking numbers of polygons, and signatures.

Equal types have equal invariants.  The converse fails for rare pairs, so these catch accidents and prove nothing.
"""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve, check_closed
from .diagram import Diagram
from .polynomials import FIELDS, alexander_values
from .projection import views

FIELD = FIELDS[0]
_ORDERS = (2, 3, 5, 7)  # of the roots of unity; these divide the number of units of the field
_VIEWS = 12  # tried until one is clear, as the first almost always is


@dataclass(frozen=True)
class QuickInvariants:
    """What is quickly computed of a knot or link of any size."""

    # of each component the values at roots of unity of order 2, 3, 5 and 7 modulo a prime: of each, which is defined up
    # to units ±tᵏ, the smallest associate
    alexander: tuple[tuple[int, ...], ...]
    linking: tuple[int, ...]  # numbers of all pairs of components: of the first with the second, the third, …

    @property
    def is_trivial(self) -> bool:
        """Whether nothing here distinguishes the curve from separate round circles."""
        return not any(self.linking) and all(values == TRIVIAL for values in self.alexander)


def quick_invariants(curve: Curve) -> QuickInvariants:
    """Those of closed polygons in space; a CurveError if some are open, or touch themselves."""
    check_closed(curve, "knot types")
    diagram = next(views(curve, _VIEWS, clear=0.0))  # strands may be as near as doubles resolve: this is no proof
    parts = range(len(diagram.passes))
    return QuickInvariants(tuple(_values(diagram.restricted({k})) for k in parts), diagram.linking_numbers)


def linking_numbers(curve: Curve) -> tuple[int, ...]:
    """Linking numbers of all pairs of components of a link in space; a CurveError as `quick_invariants`."""
    check_closed(curve, "linking numbers")
    return next(views(curve, _VIEWS, clear=0.0)).linking_numbers


def _values(knot: Diagram) -> tuple[int, ...]:
    """Values of the Alexander polynomial of one component, one after the other: matrices may be large."""
    if knot.crossings < 3:
        return TRIVIAL
    found = [int(alexander_values(knot, np.array([FIELD.root_of_unity(q)]), FIELD)[0]) for q in _ORDERS]
    return tuple(map(_smallest_associate, found, _ORDERS))


def _smallest_associate(value: int, q: int) -> int:
    units = (pow(FIELD.root_of_unity(q), k, FIELD.prime) for k in range(q))
    return min(x for unit in units for x in (value * unit % FIELD.prime, -value * unit % FIELD.prime))


TRIVIAL = tuple(_smallest_associate(1, q) for q in _ORDERS)


def signature(knot: Diagram) -> int:
    """Signature of a knot, −2 for the right-handed trefoil (Gordon and Litherland, *Inventiones* 47, 1978).

    It is that of the Goeritz matrix of the white faces of a chessboard coloring, corrected by the crossings at which
    both strands run the same way along the black surface.
    """
    if not knot.crossings:
        return 0
    white, count = _white(knot), len(knot.faces)
    goeritz, correction = np.zeros((count, count)), 0
    for darts, sign in zip(knot.darts, knot.signs, strict=True):
        corners = [knot.face_of[dart] for dart in darts]  # lower right, upper right, upper left and lower left
        turn = 1 if white[corners[0]] else -1
        a, b = corners[::2] if turn > 0 else corners[1::2]
        correction += turn * (turn == sign)
        goeritz[[a, b], [a, b]] += turn
        goeritz[[a, b], [b, a]] -= turn
    kept = np.flatnonzero(white)[1:]
    eigenvalues = np.linalg.eigvalsh(goeritz[np.ix_(kept, kept)])  # none is 0: the determinant of a knot is odd
    return int(np.sign(eigenvalues).sum()) - correction


def _white(knot: Diagram) -> list[bool]:
    """Whether each face is white, where faces on both sides of an edge have different colors."""
    white = {0: True}
    waiting = [0]
    while waiting:
        here = waiting.pop()
        for there in {knot.face_of[dart ^ 1] for dart in knot.faces[here]}.difference(white):
            white[there] = not white[here]
            waiting.append(there)
    return [white[k] for k in range(len(knot.faces))]
