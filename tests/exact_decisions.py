"""The checker's decisions about motions given by two frames, up to any time, and a search's answers judged by them."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from mobius_flow.core.collision import FreeMotion
from mobius_flow.core.proof import checker

Frame = Any  # points, rows of an array whose entries are doubles or dyadic fractions
Decision = Callable[[Frame, Frame], bool]


def ways(start: Frame, end: Frame) -> list[checker.Motion]:
    points = checker.whole([tuple(map(Fraction, p)) for p in (*start, *end)])
    return list(zip(points[: len(start)], points[len(start) :], strict=True))


def meet(start: Frame, end: Frame) -> bool:
    """Whether two edges meet; rows of the frames are x₀, x₁, y₀, y₁."""
    return checker.meet(*ways(start, end))


def meet_triangle(start: Frame, end: Frame) -> bool:
    """Whether an edge meets a triangle; rows of the frames are x₀, x₁, y₀, y₁, y₂."""
    return checker.meet_triangle(*ways(start, end))


def opposite_edges_meet(start: Frame, end: Frame) -> bool:
    """Whether a quadrilateral goes through itself."""
    return any(meet([start[k] for k in four], [end[k] for k in four]) for four in ((0, 1, 2, 3), (1, 2, 3, 0)))


def until(decide: Decision, start: Frame, end: Frame, time: float) -> bool:
    """What is decided about the motion up to a time."""
    first, last = (np.vectorize(Fraction, otypes=[object])(points) for points in (start, end))
    return decide(start, first + Fraction(time) * (last - first))


@dataclass
class Tally:
    """How a search's answers compare with a decision.

    Attributes
    ----------
    hits, misses
        Motions with a contact, and without any.
    wrong
        Contacts that were not seen, or only after they had happened.
    timid, blunt
        Motions without contact that were refused, and contacts of which less than 98 % of the time was proved.
    """

    decide: Decision
    hits: int = 0
    misses: int = 0
    wrong: int = 0
    timid: int = 0
    blunt: int = 0

    def add(self, start: Any, end: Any, answer: FreeMotion) -> None:
        """Judge the answer for one motion."""
        if not self.decide(start, end):
            self.misses += 1
            self.timid += not answer.proved
            return
        self.hits += 1
        if self.decide(start, start):
            self.wrong += answer.proved or answer.time > 0
            return
        self.wrong += answer.proved or (answer.time > 0 and until(self.decide, start, end, answer.time))
        self.blunt += not until(self.decide, start, end, min(1.0, answer.time / 0.98))
