"""What is told of the type of a polygon in space: a name of the table, several, or none."""

import re
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import prod

from ..arguments import checked
from ..curve import Curve
from ..diagrams import (
    Diagram,
    alexander,
    doubled_bracket,
    factors,
    is_least,
    jones,
    knot_signature,
    shuffled_down,
    simplified,
    views,
)
from ..errors import CurveError, counted
from .catalogue import (
    KNOTS_TO,
    LINKS_TO,
    alexander_of,
    bracket_key,
    crossing_number,
    doubled_of,
    key,
    linking_of,
    signature_of,
    types_with,
)

MAX_VERTICES = 20_000  # seconds to find the crossings
_VIEWS = 12  # a curve of many crossings simplifies better in some
_DOUBLED_TO = 14  # crossings of knots whose doubles are looked at
_MAX_NAMES = 16  # in a list of names one of which is the right one

_UNKNOT = re.compile(r"\b0_1\b")
NO_CROSSINGS, JONES, ALEXANDER = "a diagram without crossings", "the Jones polynomial", "the Alexander polynomial"
SIGNATURE, DOUBLED, LINKING = "the signature", "the Jones polynomial of the doubled knot", "linking numbers"


@dataclass(frozen=True)
class KnotType:
    """What is told of a type.

    Attributes
    ----------
    names
        Those of the table that fit, with m for mirror images, # for sums and ⊔ between parts that come apart; in 0_1
        ⊔ 0_1 two circles.  Empty if none fits.
    proved
        Whether it is certain that the type is one of the names: no knot of so few crossings is left out.
    diagram
        With the fewest crossings that were found; None if none was looked for.
    evidence
        What tells the names from others.
    untold
        Why no diagram was looked for; empty if one was.
    """

    names: tuple[str, ...]
    proved: bool
    diagram: Diagram | None
    evidence: tuple[str, ...]
    untold: str = ""

    def __repr__(self) -> str:
        return f"<KnotType: {self.sentence:.100}>"

    def __str__(self) -> str:
        return _UNKNOT.sub("unknot", " or ".join(self.names)) if self.names else "not told"

    @cached_property
    def alexander(self) -> tuple[int, ...] | None:
        """Coefficients of the Alexander polynomial, positive at t = 1; None for links and large diagrams."""
        diagram = self.diagram
        return alexander(diagram) if diagram is not None and len(diagram.passes) == 1 else None

    @cached_property
    def jones(self) -> dict[int, int] | None:
        """Coefficients of the Jones polynomial by powers of √t; None where it was not computed."""
        found = None if self.diagram is None else jones(self.diagram)
        return None if found is None else dict(found)

    @property
    def determinant(self) -> int | None:
        """|Δ(−1)|; None where the Alexander polynomial is."""
        found = self.alexander
        return None if found is None else abs(sum((-1) ** k * c for k, c in enumerate(found)))

    @property
    def sentence(self) -> str:
        """The short form, and how that is known."""
        if self.diagram is None:
            return self.untold
        most = f"a diagram of {counted(self.diagram.crossings, 'crossing')}"
        if not self.names:
            polynomial = "" if self.alexander is None else f"Alexander polynomial {list(self.alexander)}, "
            return f"not told: {polynomial}{most}"
        how = ", ".join(self.evidence) + ("" if self.evidence == (NO_CROSSINGS,) else f", {most}")
        return f"{self} ({'proved by' if self.proved else 'not proved; it fits'} {how})"


@checked
def knot_type(curve: Curve) -> KnotType:
    """Tell the type of closed polygons in space that do not touch themselves; open ones have none.

    The diagram is simplified by moves that keep the type; a knot whose diagram then has no crossing is the unknot, and
    of no more than ten (links: seven) it is the one of the table that has its polynomials.  Sums that the diagram shows
    are told factor by factor.  How long it takes is bounded by counts: diagrams that keep too many crossings are not
    told.
    """
    untold = _untold(curve)
    return KnotType((), False, None, (), untold) if untold else type_of_diagram(_simplest(curve))


def _untold(curve: Curve) -> str:
    """Why a curve has no type, or too many vertices to tell it; empty for all others."""
    if not curve.mesh.all_closed:
        which = "this one is open" if len(curve.mesh.component_sizes) == 1 else "some parts of this one are open"
        return f"none: only closed curves have a knot type, and {which}"
    if curve.dimension != 3:
        return f"none: only curves in space have a knot type, and this one is in dimension {curve.dimension}"
    if len(curve) > MAX_VERTICES:
        return f"not told: the curve has {len(curve):,} vertices, more than {MAX_VERTICES:,}"
    return ""


def type_of_diagram(diagram: Diagram) -> KnotType:
    """Tell the type of a simplified diagram."""
    pieces = [[_factor_type(factor) for factor in factors(piece)] for piece in diagram.pieces()]
    every = [each for piece in pieces for each in piece]
    names: set[str] = set()
    if 0 < prod(len(each.names) for each in every) <= _MAX_NAMES:
        sums = [[_sum(chosen) for chosen in product(*(each.names for each in piece))] for piece in pieces]
        names = {" ⊔ ".join(sorted(parts, key=_order)) for parts in product(*sums)}
    evidence = dict.fromkeys(reason for each in every for reason in each.evidence)
    if len(evidence) > 1:
        evidence.pop(NO_CROSSINGS, None)
    proved = bool(names) and all(each.proved for each in every)
    return KnotType(tuple(sorted(names, key=_order)), proved, diagram, tuple(evidence))


def _simplest(curve: Curve) -> Diagram:
    """The diagram with the fewest crossings of several views, or one that is simple enough."""
    best: Diagram | None = None
    for view in views(curve, _VIEWS):
        found = simplified(view)
        best = found if best is None or found.crossings < best.crossings else best
        if _is_enough(best):
            return best
    if best is None:
        raise CurveError("strands are so near to each other that no view of the curve tells which one is in front")
    return shuffled_down(best, _is_enough)


def _is_enough(diagram: Diagram) -> bool:
    """Whether the table, or the number of crossings, decides the type."""
    every = (factor for piece in diagram.pieces() for factor in factors(piece))
    return all(factor.crossings <= _complete(factor) or is_least(factor) for factor in every)


def _complete(factor: Diagram) -> int:
    """Crossings up to which the table has all types."""
    return KNOTS_TO if len(factor.passes) == 1 else LINKS_TO


def _sum(names: tuple[str, ...]) -> str:
    return "#".join(sorted((name for name in names if name != "0_1"), key=_order)) or "0_1"


def _order(name: str) -> tuple[int, str]:
    return sum(map(crossing_number, name.split(" ⊔ "))), name


def _factor_type(factor: Diagram) -> KnotType:
    """The type of a factor, by the table."""
    if not factor.crossings:
        return KnotType(("0_1",), True, factor, (NO_CROSSINGS,))
    complete = _complete(factor)
    bracket = bracket_key(factor)
    if bracket is None:
        return KnotType((), False, factor, ())
    names = types_with(bracket, min(factor.crossings, complete))
    if is_least(factor):
        names = [name for name in names if crossing_number(name) == factor.crossings]
    names, evidence = (_told_apart if len(factor.passes) == 1 else _links_told_apart)(factor, names)
    return KnotType(tuple(names), factor.crossings <= complete, factor, (JONES, *evidence))


def _told_apart(knot: Diagram, names: list[str]) -> tuple[list[str], list[str]]:
    """Those of the names that have the knot's other invariants, and which of these were needed."""
    polynomial, evidence = alexander(knot), []
    if polynomial is not None:
        names, evidence = [name for name in names if alexander_of(name) == polynomial], [ALEXANDER]
    if len(names) > 1:
        signature = knot_signature(knot)
        names, evidence = [name for name in names if signature_of(name) == signature], [*evidence, SIGNATURE]
    doubled = doubled_bracket(knot) if names and knot.crossings <= _DOUBLED_TO else None
    if doubled is not None and (len(names) > 1 or knot.crossings > KNOTS_TO):
        names, evidence = [name for name in names if doubled_of(name) == key(doubled)], [*evidence, DOUBLED]
    return names, evidence


def _links_told_apart(link: Diagram, names: list[str]) -> tuple[list[str], list[str]]:
    numbers = sorted(map(abs, link.linking_numbers))
    return [name for name in names if linking_of(name) == numbers], [LINKING]
