"""The size of moving curves: the flow keeps lengths, but viewers may want the size kept instead.

Scaling each key by a factor of its own about a centre of its own makes no contact.  Between keys A and B scaled by
a, b > 0 the straight motion is

    (1 − t) a A + t b B = ((1 − t) a + t b) ((1 − u) A + u B),    u = t b / ((1 − t) a + t b),

up to a translation: the straight motion from A to B, passed at another pace and seen at another size.  It is free of
contact exactly where that is.  What remains to be proved, as always, is what rounding to Blender's numbers makes of it.
"""

from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from ...core import Curve, Iterate
from ...core.types import FloatArray


class Measure(Enum):
    """The quantity that stays constant; the values are its names for people."""

    LENGTH = "Length"
    BOX = "Bounding Box"
    RADIUS = "Radius"

    def of(self, curve: Curve) -> float:
        """How large a curve is: its length, the longest side of its box, or its radius of gyration."""
        if self is Measure.LENGTH:
            return curve.length
        if self is Measure.BOX:
            return float(np.ptp(curve.vertices, axis=0).max())
        away = np.square(curve.midpoints - barycenter(curve)).sum(axis=1) + curve.edge_lengths**2 / 12
        return float(np.sqrt(curve.edge_lengths @ away / curve.length))


def barycenter(curve: Curve) -> FloatArray:
    """The centre of gravity of a curve's edges; shape (m,)."""
    return np.asarray(curve.edge_lengths @ curve.midpoints / curve.length)


@dataclass(frozen=True)
class Size:
    """A size that all curves of a motion are given, until something is pinned: then all are scaled like that one."""

    measure: Measure  # the quantity measured
    value: float  # its value for all of them
    like: Curve | None = field(default=None, compare=False)  # the curve whose factor and centre are those of all

    @classmethod
    def of(cls, measure: Measure, curve: Curve) -> "Size":
        return cls(measure, measure.of(curve))

    def factor(self, curve: Curve) -> float:
        return self.value / self.measure.of(self.like or curve)

    def given_to(self, curve: Curve) -> Curve:
        """A curve of this size, scaled about its barycenter."""
        factor, center = self.factor(curve), barycenter(self.like or curve)
        return curve if factor == 1.0 else curve.with_vertices(center + factor * (curve.vertices - center))

    def taken_from(self, point: FloatArray, curve: Curve) -> FloatArray:
        """The point, shape (m,), that appears at a given one when a curve is shown at this size."""
        center = barycenter(self.like or curve)
        return np.asarray(center + (point - center) / self.factor(curve))

    def given_to_iterate(self, iterate: Iterate) -> Iterate:
        """An iterate whose curve, and whose path to it, are scaled leg by leg."""
        curve = iterate.curve
        path = tuple(self.given_to(curve.with_vertices(end)).vertices for end in iterate.path)
        return replace(iterate, curve=self.given_to(curve), path=path)
