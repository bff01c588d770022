"""The checker's decisions about motions given by two frames, and the times at which it finds contacts."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from mobius_flow.core.proof import checker
from mobius_flow.core.proof.checker import Motion

Frame = Sequence[Sequence[Any]]  # points with coordinates that are whole numbers, doubles or dyadic fractions


def ways(start: Frame, end: Frame) -> list[Motion]:
    points = checker.whole([tuple(p) for p in (*start, *end)])
    return list(zip(points[: len(start)], points[len(start) :], strict=True))


def meet(start: Frame, end: Frame) -> bool:
    return checker.meet(*ways(start, end))


def meet_triangle(start: Frame, end: Frame) -> bool:
    return checker.meet_triangle(*ways(start, end))


class Root:
    """A time of contact, in an interval of at most 2⁻⁸⁰ of its upper end."""

    def __init__(self, time: checker.Time) -> None:
        while (time[2] - time[1]) << 80 > time[2]:
            time = checker.halved(time)
        _, i, j, m = self.time = time
        self.low, self.high = Fraction(i, m), Fraction(j, m)

    def sign_of(self, q: Sequence[int]) -> int:
        """The sign of a polynomial in t, lowest degree first."""
        total = [0] * len(q)
        for k, c in enumerate(q):
            term = [0] * k + [c]
            for _ in range(len(q) - 1 - k):
                term = checker.times(term, (1, 1))
            total = checker.plus(total, term)
        found = checker.sign(total, self.time)
        return (found > 0) - (found < 0)


def meetings(start: Frame, end: Frame) -> list[Root]:
    """Times at which two edges meet, the first among them; rows of the frames are x₀, x₁, y₀, y₁."""
    return [Root(time) for time in checker.meetings(*ways(start, end))]
