"""A quick signature of a knot type: values of the Alexander polynomial, and linking numbers.

Equal types have equal signatures.  The converse fails for rare pairs, so this catches accidents and proves nothing.
Units ±tᵏ, up to which the polynomial is defined, are divided out by taking the smallest associate of each value.
"""

from dataclasses import dataclass

import numpy as np

from ..curve import Curve, check_closed
from ..diagrams import Diagram, views
from ..diagrams.alexander import FIELDS, values
from ..errors import CurveError

FIELD = FIELDS[0]
_ORDERS = (2, 3, 5, 7)
_VIEWS = 12


@dataclass(frozen=True)
class Signature:
    """What can be told quickly of the type of a knot or link.

    Attributes
    ----------
    alexander
        For each component, the polynomial's values at roots of unity of order 2, 3, 5 and 7 modulo a prime.
    linking
        Linking numbers of all pairs of components.
    """

    alexander: tuple[tuple[int, ...], ...]
    linking: tuple[int, ...]

    @property
    def is_trivial(self) -> bool:
        """Whether nothing tells the curve from separate round circles."""
        return not any(self.linking) and all(values == TRIVIAL for values in self.alexander)


def signature(curve: Curve) -> Signature:
    """The signature of closed polygons in space; a CurveError if some are open, or touch themselves."""
    check_closed(curve, "knot types")
    diagram = _seen(curve)
    parts = range(len(diagram.passes))
    return Signature(tuple(_values(diagram.restricted({k})) for k in parts), diagram.linking_numbers)


def linking_numbers(curve: Curve) -> tuple[int, ...]:
    """Linking numbers of all pairs of components of a link in space; a CurveError as `signature` does."""
    check_closed(curve, "linking numbers")
    return _seen(curve).linking_numbers


def _seen(curve: Curve) -> Diagram:
    """What is seen of a curve whose strands may be as near to each other as numbers tell: nothing here is a proof."""
    found = next(views(curve, _VIEWS, clear=0.0), None)
    if found is None:
        raise CurveError("the curve touches itself: no view of it tells which strand is in front")
    return found


def _values(knot: Diagram) -> tuple[int, ...]:
    """Values of the Alexander polynomial of one component, one after the other: matrices may be large."""
    if knot.crossings < 3:
        return TRIVIAL
    found = (values(knot, np.array([FIELD.root_of_unity(q)]), FIELD)[0] for q in _ORDERS)
    return tuple(_smallest_associate(int(value), q) for value, q in zip(found, _ORDERS, strict=True))


def _smallest_associate(value: int, q: int) -> int:
    units = (pow(FIELD.root_of_unity(q), k, FIELD.prime) for k in range(q))
    return min(x for unit in units for x in (value * unit % FIELD.prime, -value * unit % FIELD.prime))


TRIVIAL = tuple(_smallest_associate(1, q) for q in _ORDERS)
