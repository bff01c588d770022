"""What invariants prove without any motion: that none leads from one curve to another, or that their types agree."""

from collections.abc import Callable, Sequence
from itertools import pairwise

from ..base.errors import MobiusFlowError
from ..base.messages import Message
from ..curve import Curve
from ..knots import knot_type
from ..knots.diagrams import Diagram, alexander, jones, signature, unsigned_linking
from ..knots.exterior import floer
from ..knots.knot_type import bracket_key


class NoMotionError(MobiusFlowError):
    """No motion leads from one curve to another, or none was found; the message says which of the two, and why."""


class DifferentError(NoMotionError):
    """No motion leads from one curve to another."""


# by whether curves are knots; cheap ones first; those of links do not depend on their orientations
_INVARIANTS: dict[bool, tuple[tuple[Message, Callable[[Diagram], object]], ...]] = {
    True: (
        (Message("signatures {a} and {b}"), signature),
        (Message("Alexander polynomials {a} and {b}"), alexander),
        (Message("different Jones polynomials"), jones),
        (Message("genera {a} and {b}, by knot Floer homology"), lambda knot: (found := floer(knot)) and found.genus),
    ),
    False: (
        (Message("linking numbers {a} and {b}, without signs"), unsigned_linking),
        (Message("different Jones polynomials"), bracket_key),
    ),
}


def compare(curves: Sequence[Curve], names: Sequence[str]) -> Message | None:
    """Say which type all curves have, if that is proved for each; None if it is not, or they have no type.

    Curves in the plane have no type, nor do open components.  Raises DifferentError, with their names, where one curve
    is shown to differ from the next.
    """
    if not all(each.mesh.all_closed and each.dimension == 3 for each in curves):
        return None
    kinds = [knot_type(each) for each in curves]
    for (a, b), called in zip(pairwise(kinds), pairwise(names), strict=True):
        told = None  # the first invariant that differs; those that are not computed are None
        for said, invariant in _INVARIANTS[len(a.diagram.passes) == 1] if a.diagram and b.diagram else ():
            found = [each.diagram and invariant(each.diagram) for each in (a, b)]
            if None not in found and found[0] != found[1]:
                shown = [str(list(each) if isinstance(each, tuple) else each).replace("-", "−") for each in found]
                told = Message(said.template, a=shown[0], b=shown[1])
                break
        if not told and not (a.proved and b.proved and not set(a.names) & set(b.names)):
            continue
        one, other = str(a), str(b)
        mirrored = other == (one[1:] if one.startswith("m") else f"m{one}")
        facts = dict(zip(("one", "other"), called, strict=True))
        if a.names and b.names:
            what = "{one} is {a}, {other} its mirror image {b}" if mirrored else "{one} is {a}, {other} is {b}"
            types = Message(what, **facts, a=one, b=other)
        else:
            types = Message("{one} and {other} are of different types", **facts)
        none = Message("{types}: no motion leads from one to the other", types=types)
        raise DifferentError(Message("{none} ({told})", none=none, told=told) if told else none)
    if not all(each.proved and each.names == kinds[0].names for each in kinds) or len(kinds[0].names) != 1:
        return None
    evidence = ", ".join(dict.fromkeys(each for kind in kinds for each in kind.evidence))
    return Message("both are {type}, by {evidence}", type=str(kinds[0]), evidence=evidence)
