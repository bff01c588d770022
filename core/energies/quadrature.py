"""Quadrature rules on [0, 1], which energies and metrics use on every edge."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..base import FloatArray, OptionError, checked, checked_fields, frozen

MAX_POINTS = 1000  # beyond, finding them takes minutes


@lru_cache(maxsize=64)
def gauss_legendre(points: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights on [0, 1], each of shape (points,), exact for polynomials of degree 2·points − 1."""
    x, w = np.polynomial.legendre.leggauss(points)
    return frozen(0.5 * (x + 1.0)), frozen(0.5 * w)


@checked_fields
@dataclass(frozen=True)
class Rule:
    """A quadrature rule: points t_i in [0, 1] and as many weights ω_i, which add up to 1, or an OptionError says so."""

    points: tuple[float, ...]
    weights: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.points or len(self.points) != len(self.weights):
            raise OptionError(
                f"the rule has {len(self.points)} points, {len(self.weights)} weights; give as many of both, 1 or more"
            )
        if not all(0.0 <= t <= 1.0 for t in self.points):
            raise OptionError(f"points are {self.points}; they must lie between 0 and 1")
        if not abs(sum(self.weights) - 1.0) < 1e-12:
            raise OptionError(f"weights are {self.weights}; they must add up to 1")

    @classmethod
    @checked
    def gauss(cls, points: int) -> "Rule":
        """Gauss–Legendre rule with ``points`` points, 1 or more; it is of order 2·points."""
        if not 1 <= points <= MAX_POINTS:
            raise OptionError(f"points is {points}; the quadrature takes 1 to {MAX_POINTS} points per edge")
        t, omega = gauss_legendre(points)
        return cls(tuple(t.tolist()), tuple(omega.tolist()))


TAIL = Rule((0.0,), (1.0,))
MIDPOINT = Rule((0.5,), (1.0,))
ENDS = Rule((0.0, 1.0), (0.5, 0.5))
