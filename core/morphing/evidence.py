"""What is known of two curves without any motion: that there is none, by invariants, or that they are the same."""

from collections.abc import Callable, Sequence

from ..curve import Curve
from ..diagrams import Diagram, alexander, jones, signature
from ..knots import KnotType, knot_type
from ..knots.catalogue import bracket_key
from ..messages import Message


def _unsigned_linking(link: Diagram) -> tuple[int, ...]:
    return tuple(sorted(map(abs, link.linking_numbers)))


_JONES = Message("different Jones polynomials")
# cheap ones first; those of links do not depend on their orientations
_OF_KNOTS: tuple[tuple[Message, Callable[[Diagram], object]], ...] = (
    (Message("signatures {a} and {b}"), signature),
    (Message("Alexander polynomials {a} and {b}"), alexander),
    (_JONES, jones),
)
_OF_LINKS: tuple[tuple[Message, Callable[[Diagram], object]], ...] = (
    (Message("linking numbers {a} and {b}, without signs"), _unsigned_linking),
    (_JONES, bracket_key),
)


def type_of(curve: Curve) -> KnotType | None:
    """The type of a curve, if it has one: in the plane, and of open components, there is none."""
    return knot_type(curve) if curve.mesh.all_closed and curve.dimension == 3 else None


def agreement(a: KnotType, b: KnotType) -> Message | None:
    """Say of which type both are, if that is proved; None if it is not."""
    if not (a.proved and b.proved and a.names == b.names and len(a.names) == 1):
        return None
    evidence = ", ".join(dict.fromkeys((*a.evidence, *b.evidence)))
    return Message("both are {type}, by {evidence}", type=str(a), evidence=evidence)


def difference(a: KnotType, b: KnotType, names: Sequence[str]) -> Message | None:
    """Say what the types of two curves, by their names, are, and which invariant tells them apart, if one does."""
    told = a.diagram and b.diagram and _told_apart(a.diagram, b.diagram)
    if not told and not (a.proved and b.proved and not set(a.names) & set(b.names)):
        return None
    one, other = str(a), str(b)
    mirrored = other == (one[1:] if one.startswith("m") else f"m{one}")
    facts = {"one": names[0], "other": names[1]}
    if a.names and b.names:
        what = "{one} is {a}, {other} its mirror image {b}" if mirrored else "{one} is {a}, {other} is {b}"
        types = Message(what, **facts, a=one, b=other)
    else:
        types = Message("{one} and {other} are of different types", **facts)
    none = Message("{types}: no motion leads from one to the other", types=types)
    return Message("{none} ({told})", none=none, told=told) if told else none


def _told_apart(a: Diagram, b: Diagram) -> Message | None:
    """The first invariant that differs; those are None that are not computed."""
    for said, invariant in _OF_KNOTS if len(a.passes) == 1 else _OF_LINKS:
        found = invariant(a), invariant(b)
        if None not in found and found[0] != found[1]:
            one, other = (str(list(each) if isinstance(each, tuple) else each).replace("-", "−") for each in found)
            return Message(said.template, a=one, b=other)
    return None
