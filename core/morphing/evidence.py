"""What is known of two curves without any motion: that there is none, by invariants, or that they are the same."""

from collections.abc import Callable, Sequence

from ..curve import Curve
from ..diagrams import Diagram, alexander, jones, signature
from ..knots import KnotType, knot_type
from ..knots.catalogue import bracket_key
from ..messages import Message


def type_of(curve: Curve) -> KnotType | None:
    """The type of a curve, if it has one: in the plane, and of open components, there is none."""
    return knot_type(curve) if curve.mesh.all_closed and curve.dimension == 3 else None


def agreement(a: KnotType, b: KnotType) -> Message | None:
    """Say of which type both are, if that is proved; None if it is not."""
    if not (a.proved and b.proved and a.names == b.names and len(a.names) == 1):
        return None
    evidence = ", ".join(dict.fromkeys((*a.evidence, *b.evidence)))
    return Message("both are {type}, by {evidence}", type=str(a), evidence=evidence)


def difference(a: KnotType, b: KnotType) -> Message | None:
    """Say what the types of two curves are, and which invariant tells them apart; None if nothing does."""
    told = a.diagram and b.diagram and _told_apart(a.diagram, b.diagram)
    if not told and not (a.proved and b.proved and not set(a.names) & set(b.names)):
        return None
    one, other = str(a), str(b)
    what = "A is {a}, B its mirror image {b}" if _mirror_image(one) == other else "A is {a}, B is {b}"
    types = Message(what, a=one, b=other) if a.names and b.names else Message("A and B are of different types")
    none = Message("{types}: no motion leads from one to the other", types=types)
    return Message("{none} ({told})", none=none, told=told) if told else none


def _told_apart(a: Diagram, b: Diagram) -> Message | None:
    """The first invariant that differs, cheap ones first; those of links do not depend on their orientations."""
    if len(a.passes) > 1:
        linking = [sorted(map(abs, each.linking_numbers)) for each in (a, b)]
        if linking[0] != linking[1]:
            one, other = (_listed(each) for each in linking)
            return Message("linking numbers {a} and {b}, without signs", a=one, b=other)
        return Message("different Jones polynomials") if _differ(bracket_key, a, b) else None
    signatures = signature(a), signature(b)
    if signatures[0] != signatures[1]:
        one, other = (str(each).replace("-", "−") for each in signatures)
        return Message("signatures {a} and {b}", a=one, b=other)
    if _differ(alexander, a, b):
        one, other = (_listed(alexander(each) or ()) for each in (a, b))
        return Message("Alexander polynomials {a} and {b}", a=one, b=other)
    return Message("different Jones polynomials") if _differ(jones, a, b) else None


def _differ(invariant: Callable[[Diagram], object], a: Diagram, b: Diagram) -> bool:
    """Whether an invariant differs, which is None where it is not computed."""
    found = invariant(a), invariant(b)
    return None not in found and found[0] != found[1]


def _listed(numbers: Sequence[int]) -> str:
    return f"[{', '.join(map(str, numbers))}]".replace("-", "−")


def _mirror_image(name: str) -> str:
    """The name of the mirror image of a prime knot or link."""
    return name[1:] if name.startswith("m") else f"m{name}"
