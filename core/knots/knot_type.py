"""The type of a polygon in space: a name from the table, several possible ones, or none; and the evidence."""

import re
from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import product
from math import prod

from ..base import checked, checked_fields, counted, number
from ..curve import Curve
from .braids import braid_diagram
from .diagrams import (
    Diagram,
    Laurent,
    alexander,
    doubled_bracket,
    factors,
    is_least,
    jones,
    normalized_bracket,
    shuffled_down,
    signature,
    simplifying,
    unsigned_linking,
    views,
)
from .diagrams.homfly import Polynomial, homfly
from .diagrams.invariants import times
from .exterior import CENSUS, FLOER, Floer, KnotGroup, floer, group, names_by_census, names_by_exterior
from .names import AMPHICHEIRAL, KNOTS, braid_word

Key = tuple[tuple[int, int], ...]  # a polynomial that can be looked up: exponents and coefficients

KNOTS_TO, LINKS_TO = 10, 7  # crossings up to which the table is complete


def key(polynomial: Laurent) -> Key:
    """A polynomial as something to look up."""
    return tuple(sorted(polynomial.items()))


def bracket_key(diagram: Diagram) -> Key | None:
    """The bracket that is the same for all diagrams and orientations; None if the diagram is too wide."""
    found = normalized_bracket(diagram, diagram.own_writhe)
    return None if found is None else key(found)


@cache
def crossing_number(name: str) -> int:
    """Crossing number of a name; for connected sums, the sum over the factors."""
    return sum(int(number) for number in re.findall(r"(?<![\d_an])\d+", name))  # with which names of factors begin


@cache
def invariant_of(name: str, invariant: Callable[[Diagram], object]) -> object:
    """An invariant of the knot or link of a name."""
    return invariant(braid_diagram(braid_word(name)))


@cache
def _by_bracket() -> Mapping[Key, list[str]]:
    """Names of the types with each bracket, those with few crossings first."""
    found: defaultdict[Key, list[str]] = defaultdict(list)
    primes: list[tuple[str, Laurent]] = []
    for name, word in KNOTS.items():
        diagram = braid_diagram(word)
        bracket = normalized_bracket(diagram, diagram.own_writhe) or {}
        primes.append((name, bracket))
        if name not in AMPHICHEIRAL:
            primes.append((f"m{name}", {-power: c for power, c in bracket.items()}))
    # all composite types: products of the factors' brackets
    every, factors_of_sums = list(primes), [each for each in primes if 0 < crossing_number(each[0]) <= KNOTS_TO - 2]
    shorter: list[tuple[str, Laurent, int]] = [(*each, k) for k, each in enumerate(factors_of_sums)]
    while shorter:
        longer: list[tuple[str, Laurent, int]] = []
        for (name, bracket, last), (k, (factor, own)) in product(shorter, enumerate(factors_of_sums)):
            joined = f"{name}#{factor}"
            if k >= last and crossing_number(joined) <= (LINKS_TO if "L" in joined else KNOTS_TO):
                longer.append((joined, times(bracket, own), k))
        every += [(name, bracket) for name, bracket, _ in longer]
        shorter = longer
    for name, bracket in sorted(every, key=lambda each: (crossing_number(each[0]), "L" in each[0])):
        found[key(bracket)].append(name)
    return found


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
    work
        Crossings visited while views are simplified, all views together: some ten seconds.
    """

    vertices: int = number(20_000)
    views: int = number(12)
    work: int = number(600_000)


DEFAULT_EFFORT = Effort()


@dataclass(frozen=True)
class KnotType:
    """What is known of a type."""

    #: names in the table that fit, if any, with m for mirror images, # for sums and ⊔ between parts that come apart
    names: tuple[str, ...]
    proved: bool  #: whether the type certainly is one of the names, as no knot of so few crossings is left out
    diagram: Diagram | None  #: the diagram with the fewest crossings that was found
    evidence: tuple[str, ...]  #: what distinguishes the names from others
    refusal: str = ""  #: why no diagram was looked for, or none was found that could be compared

    def __repr__(self) -> str:
        return f"<KnotType: {self.sentence:.100}>"

    def __str__(self) -> str:
        return re.sub(r"\b0_1\b", "unknot", " or ".join(self.names)) if self.names else "not identified"

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
    def homfly(self) -> Polynomial | None:
        """Coefficients of the HOMFLY polynomial by powers of v and z; None where it was not computed."""
        return homfly(self.diagram) if self.diagram else None

    @cached_property
    def floer(self) -> Floer | None:
        """Knot Floer homology, and by it genus and fiberedness; None for links, or without the extra "knots"."""
        return floer(self.diagram) if self.diagram else None

    @cached_property
    def group(self) -> KnotGroup | None:
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
    refusal = ""
    if not curve.mesh.all_closed:
        which = "this one is open" if len(curve.mesh.component_sizes) == 1 else "some parts of this one are open"
        refusal = f"none: only closed curves have a knot type, and {which}"
    elif curve.dimension != 3:
        refusal = f"none: only curves in space have a knot type, and this one is in dimension {curve.dimension}"
    elif len(curve) > effort.vertices:
        refusal = f"not identified: the curve has {len(curve):,} vertices, more than {effort.vertices:,}"
    if refusal:
        return KnotType((), False, None, (), refusal)
    best, left = None, effort.work
    for view in views(curve, effort.views):
        for diagram in simplifying(view):
            left -= diagram.crossings
            if left < 0:
                break
        else:
            best = diagram if best is None or diagram.crossings < best.crossings else best
        if left < 0 or (best is not None and _is_enough(best)):
            break
    if best is None:
        told = f"not identified: {diagram.crossings:,} crossings are left after as much simplifying as is allowed"
        return KnotType((), False, None, (), told)
    return type_of_diagram(shuffled_down(best, _is_enough))


def type_of_diagram(diagram: Diagram) -> KnotType:
    """Identify the type of a simplified diagram."""
    pieces = [[_factor_type(factor) for factor in factors(piece)] for piece in diagram.pieces()]
    every = [each for piece in pieces for each in piece]
    names: set[str] = set()
    if 0 < prod(len(each.names) for each in every) <= 16:  # longer lists of possible names tell nobody anything
        chosen = (product(*(each.names for each in piece)) for piece in pieces)
        knotted = [[[name for name in each if name != "0_1"] for each in ways] for ways in chosen]
        sums = [["#".join(sorted(each, key=_order)) or "0_1" for each in ways] for ways in knotted]
        names = {" ⊔ ".join(sorted(parts, key=_order)) for parts in product(*sums)}
    evidence = dict.fromkeys(reason for each in every for reason in each.evidence)
    if len(evidence) > 1:
        evidence.pop(NO_CROSSINGS, None)
    proved = bool(names) and all(each.proved for each in every)
    return KnotType(tuple(sorted(names, key=_order)), proved, diagram, tuple(evidence))


def _is_enough(diagram: Diagram) -> bool:
    """Whether the table, or the number of crossings, decides the type."""
    every = (factor for piece in diagram.pieces() for factor in factors(piece))
    return all(factor.crossings <= _complete(factor) or is_least(factor) for factor in every)


def _complete(factor: Diagram) -> int:
    """Crossings up to which the table has all types."""
    return KNOTS_TO if len(factor.passes) == 1 else LINKS_TO


def _order(name: str) -> tuple[int, str]:
    return sum(map(crossing_number, name.split(" ⊔ "))), name


def _factor_type(factor: Diagram) -> KnotType:
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
    least = factor.crossings if is_least(factor) else 0
    most = min(factor.crossings, complete)
    names = [name for name in _by_bracket().get(bracket, ()) if least <= crossing_number(name) <= most]
    evidence = [JONES]

    def compare(invariant: Callable[[Diagram], object], reason: str) -> None:
        """Keep the names that have the factor's invariant, if it can be computed."""
        found = invariant(factor)
        if found is not None:
            names[:] = [name for name in names if invariant_of(name, invariant) == found]
            evidence.append(reason)

    if len(factor.passes) > 1:
        compare(unsigned_linking, LINKING)
    else:
        compare(alexander, ALEXANDER)
        if len(names) > 1:
            compare(signature, SIGNATURE)
        # doubles have four times as many crossings
        if names and factor.crossings <= 14 and (len(names) > 1 or factor.crossings > KNOTS_TO):
            compare(doubled_bracket, DOUBLED)
        if names and factor.crossings > KNOTS_TO:
            compare(floer, FLOER)
    names = [name for name in names if name in known] if known else names
    if not names and not known and (larger := names_by_census(factor)):
        return KnotType(larger, False, factor, (CENSUS,))
    return KnotType(tuple(names), factor.crossings <= complete or bool(known), factor, tuple(evidence))
