"""Along a way by proved legs."""

from collections.abc import Callable, Iterator
from typing import TypeVar

from ..base.deadline import check_time

Proved = TypeVar("Proved")


def walk(
    leg: Callable[[float, float], Proved | None], end: float, longest: float, shortest: float
) -> Iterator[tuple[float, Proved]]:
    """Yield the proved legs of a way from 0 to ``end``, each with the place it leads to.

    ``leg(place, stride)`` tries to go on from a place by a stride, to the way's end at most: it returns what is proved,
    or None.  A stride along which nothing is proved is halved; after a leg the next one is twice as long, up to the
    longest.  Where strides shorter than ``shortest`` were needed the walk ends: what it has yielded is a part of the
    way.
    """
    place, stride = 0.0, longest
    while place < end and stride >= shortest:
        check_time()
        found = leg(place, stride)
        if found is None:
            stride *= 0.5
        else:
            place += stride
            yield place, found
            stride = min(2.0 * stride, longest)
