"""Steps, their proofs, and the one way to try a step: back to the constraints, compare, prove."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..base import FloatArray, Message
from ..collision import Contact, FreeMotion
from ..solve.saddle import TangentSpace
from .problem import Point, Problem


@dataclass(frozen=True, eq=False)
class SearchState:
    """What a method remembers between steps: its own memory, None at the start, and the last accepted step size."""

    memory: Any = None
    last_step: float = np.inf


class Leg(NamedTuple):
    """A straight motion to a point, and what is proved of it."""

    end: Point
    proof: FreeMotion

    @property
    def open(self) -> bool:
        """Whether nothing is in the way; that this is also proved says ``proof.proved``."""
        return self.proof.time == 1.0


class Rejected(NamedTuple):
    """A trial that is no step."""

    trial: Point | None = None  # where it would have ended; None if it cannot be brought back to the constraints
    proof: FreeMotion | None = None  # what was proved of the way there, if only contact is against it

    @property
    def in_the_way(self) -> Contact | None:
        return None if self.proof is None else self.proof.contact


def leg(start: Point, end: Point) -> Leg:
    """The straight motion between two points, in the rounded coordinates that users get to see."""
    return Leg(end, end.problem.free_motion(start.placed, end.placed))


def attempt(
    base: Point,
    vertices: FloatArray,
    level: FloatArray,
    acceptable: Callable[[Point], bool],
    space: TangentSpace | None = None,
) -> Leg | Rejected:
    """Try to go straight from a base to the point that vertices near it, shape (n, m), are led back to.

    The end has a level of the constraints' residual, and is ``acceptable``, which is asked where the energy is finite.
    The metric of the way back, ``space``, is that of the base by default.
    """
    return judged(base, base.retract(vertices, level, space), acceptable)


def judged(base: Point, trial: Point | None, acceptable: Callable[[Point], bool]) -> Leg | Rejected:
    """Compare and prove: the end of `attempt`, for a point that has been brought back to the constraints."""
    if trial is None or not math.isfinite(trial.energy):
        return Rejected()
    if not acceptable(trial):
        return Rejected(trial)
    motion = leg(base, trial)
    return motion if motion.open else Rejected(trial, motion.proof)


@dataclass(frozen=True, eq=False)
class Step:
    """An accepted step."""

    legs: tuple[Leg, ...]  # the straight motions that lead to its end, one after the other, at least one
    size: float  # its τ; 0 for a motion of a move, which no search along a direction has found
    limited_by: Contact | None  # the contact that limited τ, if any

    @property
    def point(self) -> Point:
        return self.legs[-1].end

    @property
    def certified(self) -> bool:
        return all(leg.proof.proved for leg in self.legs)

    def within(self, problem: Problem) -> "Step":
        """The same step, ending at the point of another problem on the same mesh."""
        return self._ending(self.point.within(problem))

    def with_metric_of(self, start: Point) -> "Step":
        """The same step, at whose end the metric is still that of its start."""
        return self._ending(self.point.with_metric_of(start))

    def _ending(self, end: Point) -> "Step":
        return replace(self, legs=(*self.legs[:-1], self.legs[-1]._replace(end=end)))


@dataclass(frozen=True)
class NoStep:
    """Why no step was found: in words, and what is in the way if it was contact."""

    reason: str
    limited_by: Contact | None = None

    @classmethod
    def because(cls, limited_by: Contact | None) -> "NoStep":
        """The usual two reasons: contact, or an energy that does not go down any more."""
        if limited_by is None:
            return cls(Message("no step along the search direction lowers the energy measurably"))
        close = Message("{contact} are so close that no step is free of contact", contact=limited_by.message)
        return cls(close, limited_by)
