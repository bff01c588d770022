"""The type of a polygon in space: a name from the table, several possible ones, or none; and the evidence."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import prod

from ..arguments import checked, checked_fields, number
from ..curve import Curve
from ..diagrams import Diagram, factors, is_least, shuffled_down, signature, simplified, views
from ..diagrams.polynomials import alexander, doubled_bracket, jones
from ..errors import counted
from .catalogue import KNOTS_TO, LINKS_TO, Key, bracket_key, crossing_number, invariant_of, key, types_with
from .exterior import FLOER, Floer, Group, floer, group, names_by_exterior

_UNKNOT = re.compile(r"\b0_1\b")
NO_CROSSINGS, JONES, ALEXANDER = "a diagram without crossings", "the Jones polynomial", "the Alexander polynomial"
SIGNATURE, DOUBLED, LINKING = "the signature", "the Jones polynomial of the doubled knot", "linking numbers"


@checked_fields
@dataclass(frozen=True)
class Effort:
    """How much is done to identify a type, in counts, so that results do not depend on a clock.

    Parameters
    ----------
    vertices
        Vertices of the largest curve whose crossings are looked for, which takes seconds.
    views
        Directions to look from: a curve of many crossings simplifies better in some.
    doubled
        Crossings of the largest knots compared by the polynomials of their doubles.
    names
        Longest list of possible names.
    """

    vertices: int = number(20_000)
    views: int = number(12)
    doubled: int = number(14)
    names: int = number(16)


DEFAULT_EFFORT = Effort()


@dataclass(frozen=True)
class KnotType:
    """What is known of a type."""

    #: names in the table that fit, if any, with m for mirror images, # for sums and ⊔ between parts that come apart
    names: tuple[str, ...]
    proved: bool  #: whether the type certainly is one of the names, as no knot of so few crossings is left out
    diagram: Diagram | None  #: the diagram with the fewest crossings that was found
    evidence: tuple[str, ...]  #: what distinguishes the names from others
    refusal: str = ""  #: why no diagram was looked for

    def __repr__(self) -> str:
        return f"<KnotType: {self.sentence:.100}>"

    def __str__(self) -> str:
        return _UNKNOT.sub("unknot", " or ".join(self.names)) if self.names else "not identified"

    @cached_property
    def alexander(self) -> tuple[int, ...] | None:
        """Coefficients of the Alexander polynomial, positive at t = 1; None for links and large diagrams."""
        return alexander(self.diagram) if self.diagram and len(self.diagram.passes) == 1 else None

    @cached_property
    def jones(self) -> dict[int, int] | None:
        """Coefficients of the Jones polynomial by powers of √t; None where it was not computed."""
        found = jones(self.diagram) if self.diagram else None
        return None if found is None else dict(found)

    @cached_property
    def floer(self) -> Floer | None:
        """Knot Floer homology, and by it genus and fiberedness; None for links, or without the extra "knots"."""
        return floer(self.diagram) if self.diagram else None

    @cached_property
    def group(self) -> Group | None:
        """The fundamental group of the complement; None where it is large, or without the extra "knots"."""
        return group(self.diagram) if self.diagram else None

    @property
    def determinant(self) -> int | None:
        """|Δ(−1)|; None where the Alexander polynomial is."""
        found = self.alexander
        return None if found is None else abs(sum((-1) ** k * c for k, c in enumerate(found)))

    @property
    def sentence(self) -> str:
        """The short form, and the evidence for it."""
        if self.diagram is None:
            return self.refusal
        size = f"a diagram of {counted(self.diagram.crossings, 'crossing')}"
        if not self.names:
            polynomial = "" if self.alexander is None else f"Alexander polynomial {list(self.alexander)}, "
            return f"not identified: {polynomial}{size}"
        how = ", ".join(self.evidence if self.evidence == (NO_CROSSINGS,) else (*self.evidence, size))
        return f"{self} ({'proved by' if self.proved else 'not proved; it fits'} {how})"


@checked
def knot_type(curve: Curve, effort: Effort = DEFAULT_EFFORT) -> KnotType:
    """Identify the type of closed polygons in space that do not touch themselves; open ones have none.

    The diagram is simplified by moves that keep the type; a knot whose diagram then has no crossing is the unknot, and
    of no more than ten (links: seven) it is the one of the table that has its polynomials.  Sums that the diagram shows
    are identified factor by factor.  Diagrams that keep too many crossings are not identified.
    """
    if refusal := _refusal(curve, effort):
        return KnotType((), False, None, (), refusal)
    return type_of_diagram(_simplest(curve, effort.views), effort)


def _refusal(curve: Curve, effort: Effort) -> str:
    """Why a curve has no type, or too many vertices to identify it; empty for all others."""
    if not curve.mesh.all_closed:
        which = "this one is open" if len(curve.mesh.component_sizes) == 1 else "some parts of this one are open"
        return f"none: only closed curves have a knot type, and {which}"
    if curve.dimension != 3:
        return f"none: only curves in space have a knot type, and this one is in dimension {curve.dimension}"
    if len(curve) > effort.vertices:
        return f"not identified: the curve has {len(curve):,} vertices, more than {effort.vertices:,}"
    return ""


def type_of_diagram(diagram: Diagram, effort: Effort = DEFAULT_EFFORT) -> KnotType:
    """Identify the type of a simplified diagram."""
    pieces = [[_factor_type(factor, effort) for factor in factors(piece)] for piece in diagram.pieces()]
    every = [each for piece in pieces for each in piece]
    names: set[str] = set()
    if 0 < prod(len(each.names) for each in every) <= effort.names:
        sums = [[_sum(chosen) for chosen in product(*(each.names for each in piece))] for piece in pieces]
        names = {" ⊔ ".join(sorted(parts, key=_order)) for parts in product(*sums)}
    evidence = dict.fromkeys(reason for each in every for reason in each.evidence)
    if len(evidence) > 1:
        evidence.pop(NO_CROSSINGS, None)
    proved = bool(names) and all(each.proved for each in every)
    return KnotType(tuple(sorted(names, key=_order)), proved, diagram, tuple(evidence))


def _simplest(curve: Curve, count: int) -> Diagram:
    """The diagram with the fewest crossings of several views, or one that is simple enough."""
    every = map(simplified, views(curve, count))
    best = next(every)
    while not _is_enough(best):
        view = next(every, None)
        if view is None:
            return shuffled_down(best, _is_enough)
        best = view if view.crossings < best.crossings else best
    return best


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


def _factor_type(factor: Diagram, effort: Effort) -> KnotType:
    """The type of a factor, by the table."""
    if not factor.crossings:
        return KnotType(("0_1",), True, factor, (NO_CROSSINGS,))
    complete = _complete(factor)
    known, how = names_by_exterior(factor) if factor.crossings > complete else ((), "")
    if known == ("0_1",):
        return KnotType(known, True, factor, (how,))
    bracket = bracket_key(factor)
    if bracket is None:
        return KnotType((), False, factor, ())
    names, evidence = types_with(bracket, min(factor.crossings, complete)), [JONES]
    if is_least(factor):
        names = [name for name in names if crossing_number(name) == factor.crossings]

    def compare(invariant: Callable[[Diagram], object], reason: str) -> None:
        """Keep the names that have the factor's invariant, if it can be computed."""
        found = invariant(factor)
        if found is not None:
            names[:] = [name for name in names if invariant_of(name, invariant) == found]
            evidence.append(reason)

    if len(factor.passes) > 1:
        compare(_linking, LINKING)
    else:
        compare(alexander, ALEXANDER)
        if len(names) > 1:
            compare(signature, SIGNATURE)
        if names and factor.crossings <= effort.doubled and (len(names) > 1 or factor.crossings > KNOTS_TO):
            compare(_doubled, DOUBLED)
        if names and factor.crossings > KNOTS_TO:
            compare(floer, FLOER)
    names = [name for name in names if name in known] if known else names
    return KnotType(tuple(names), factor.crossings <= complete or bool(known), factor, tuple(evidence))


def _linking(link: Diagram) -> list[int]:
    """Linking numbers without their signs, which orientations decide; sorted."""
    return sorted(map(abs, link.linking_numbers))


def _doubled(knot: Diagram) -> Key | None:
    found = doubled_bracket(knot)
    return None if found is None else key(found)
