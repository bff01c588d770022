"""What invariants prove without any motion: that none leads from one curve to another, or that their types agree."""

from collections.abc import Callable, Sequence
from itertools import pairwise

from ..curve import Curve
from ..diagrams import Diagram, alexander, jones, signature
from ..errors import MobiusFlowError
from ..knots import KnotType, knot_type
from ..knots.catalogue import bracket_key
from ..messages import Message

_JONES = Message("different Jones polynomials")


class NoMotionError(MobiusFlowError):
    """No motion leads from one curve to another, or none was found; the message says which of the two, and why."""


class DifferentError(NoMotionError):
    """No motion leads from one curve to another."""


def _unsigned_linking(link: Diagram) -> tuple[int, ...]:
    return tuple(sorted(map(abs, link.linking_numbers)))


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


def compare(curves: Sequence[Curve], names: Sequence[str]) -> Message | None:
    """Say which type all curves have, if that is proved for each; None if it is not, or they have no type.

    Curves in the plane have no type, nor do open components.  Raises DifferentError, with their names, where one curve
    is shown to differ from the next.
    """
    if not all(each.mesh.all_closed and each.dimension == 3 for each in curves):
        return None
    kinds = [knot_type(each) for each in curves]
    for pair, called in zip(pairwise(kinds), pairwise(names), strict=True):
        _refuse_different(*pair, called)
    if not all(each.proved and each.names == kinds[0].names for each in kinds) or len(kinds[0].names) != 1:
        return None
    evidence = ", ".join(dict.fromkeys(each for kind in kinds for each in kind.evidence))
    return Message("both are {type}, by {evidence}", type=str(kinds[0]), evidence=evidence)


def _refuse_different(a: KnotType, b: KnotType, names: Sequence[str]) -> None:
    """Raise a DifferentError with the types of two curves, if they differ, and the invariant that shows it, if any."""
    told = a.diagram and b.diagram and _told_apart(a.diagram, b.diagram)
    if not told and not (a.proved and b.proved and not set(a.names) & set(b.names)):
        return
    one, other = str(a), str(b)
    mirrored = other == (one[1:] if one.startswith("m") else f"m{one}")
    facts = {"one": names[0], "other": names[1]}
    if a.names and b.names:
        what = "{one} is {a}, {other} its mirror image {b}" if mirrored else "{one} is {a}, {other} is {b}"
        types = Message(what, **facts, a=one, b=other)
    else:
        types = Message("{one} and {other} are of different types", **facts)
    none = Message("{types}: no motion leads from one to the other", types=types)
    raise DifferentError(Message("{none} ({told})", none=none, told=told) if told else none)


def _told_apart(a: Diagram, b: Diagram) -> Message | None:
    """The first invariant that differs; those that are not computed are None."""
    for said, invariant in _OF_KNOTS if len(a.passes) == 1 else _OF_LINKS:
        found = invariant(a), invariant(b)
        if None not in found and found[0] != found[1]:
            one, other = (str(list(each) if isinstance(each, tuple) else each).replace("-", "−") for each in found)
            return Message(said.template, a=one, b=other)
    return None
