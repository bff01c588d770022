"""The potential of single triangles and segments in closed form, and how far it is analytic along a line.

    Φ(x) = ∫_T dA(y)/|x − y|³ = Ω/h       for triangles,
    Φ(x) = 2 ∫_S ds(y)/|x − y|² = 2 ψ/h    for segments,

with the solid angle Ω or the angle ψ under which a point x sees the simplex, and its distance h from the simplex's
plane or line.  By tan(Ω/2) = N/D (Van Oosterom and Strackee, 1983) and tan ψ = N/D, with N proportional to h, both are
a constant times atan2(N, D)/N: nothing happens where x is in the plane or on the line, beside the simplex.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...types import BoolArray, FloatArray, IntArray, frozen
from .arctangent import ArctangentQuotient
from .forms import Form, SegmentForm, TriangleForm
from .vectors import cross, dot, norm


class Potentials(NamedTuple):
    """A potential Φ at points: values, shape (k, points), and gradients, shape (3, k, points)."""

    value: FloatArray
    gradient: FloatArray


@dataclass(frozen=True, eq=False)
class Simplices:
    """Triangles or segments in space.

    Parameters
    ----------
    corners
        Shape (3, 3, f) for triangles, (2, 3, f) for segments: corner, coordinate, simplex.
    """

    corners: FloatArray

    @property
    def are_triangles(self) -> bool:
        """Whether they are triangles rather than segments."""
        return len(self.corners) == 3

    @property
    def exponent(self) -> int:
        """p of the kernel 1/rᵖ: one more than the simplices' dimension."""
        return len(self.corners)

    @property
    def strength(self) -> float:
        """The kernel's factor, with which a plane and a line have the same potential 2π/h."""
        return 1.0 if self.are_triangles else 2.0

    @cached_property
    def sides(self) -> FloatArray:
        """Vectors from corner to corner, around triangles and along segments; shape (3, 3, f) or (1, 3, f)."""
        sides = np.roll(self.corners, -1, axis=0) - self.corners
        return frozen(sides if self.are_triangles else sides[:1])

    @cached_property
    def normals(self) -> FloatArray:
        """Normals of triangles, twice their areas long; shape (3, f)."""
        return frozen(cross(self.sides[0], self.sides[1]))

    @cached_property
    def sizes(self) -> FloatArray:
        """Areas or lengths; shape (f,)."""
        return frozen(0.5 * norm(self.normals) if self.are_triangles else norm(self.sides[0]))

    def potential(self, index: IntArray, x: FloatArray) -> Potentials:
        """Φ of the simplices ``index``, shape (k,), each at its own points x, shape (3, k, points)."""
        form = self._form(index, x)
        g = ArctangentQuotient.at(form.square, form.d)
        factor = self._factors[index, None]
        return Potentials(factor * g.value, factor * (g.by_square * form.slope_of_square + g.by_d * form.slope_of_d))

    def change(self, index: IntArray, x: FloatArray, v: FloatArray) -> Potentials:
        """The derivatives of Φ and ∇Φ as the points move with velocities v, shape (3, k, points)."""
        form = self._form(index, x)
        g = ArctangentQuotient.at(form.square, form.d)
        rate = g.change(form.square, form.d, dot(form.slope_of_square, v), dot(form.slope_of_d, v))
        gradient = rate.by_square * form.slope_of_square + rate.by_d * form.slope_of_d
        square_bend, d_bend = form.bend(v)
        gradient += g.by_square * square_bend + g.by_d * d_bend
        factor = self._factors[index, None]
        return Potentials(factor * rate.value, factor * gradient)

    def reach(self, index: IntArray, x: FloatArray, tau: FloatArray) -> FloatArray:
        """Radii of discs |z| < reach in which z ↦ Φ(x + z τ) is analytic; x and unit vectors τ of shape (3, k).

        Ω and ψ have their singularities where the complex distance from a corner, or from the line of a side,
        vanishes; Φ has a pole where the line meets the plane.  Lines and planes count only if the foot of x is within
        the simplex: for others the corners and sides are nearer.
        """
        seen, sides = x - self.corners[:, :, index], self.sides[:, :, index]
        square = np.min([dot(a, a) for a in seen], axis=0)
        for a, side in zip(seen, sides, strict=False):
            along = dot(a, side)
            beside = (along > 0.0) & (along < dot(side, side))
            off, across = cross(a, side), cross(tau, side)
            square = np.where(beside, np.minimum(square, _quotient(dot(off, off), dot(across, across))), square)
        if self.are_triangles:
            normal = self.normals[:, index]
            pole = _quotient(dot(normal, seen[0]) ** 2, dot(normal, tau) ** 2)
            square = np.where(_is_above(seen, sides, normal), np.minimum(square, pole), square)
        return np.asarray(np.sqrt(square))

    @cached_property
    def _factors(self) -> FloatArray:
        """Φ N/atan2(N, D) of each simplex; shape (f,)."""
        return (4.0 if self.are_triangles else 2.0) * self.sizes

    def _form(self, index: IntArray, x: FloatArray) -> Form:
        seen = self.corners[:, :, index, None] - x
        if self.are_triangles:
            a, b, c = seen
            return TriangleForm(a, b, c, self.normals[:, index, None])
        a, b = seen
        return SegmentForm(a, b)


def _is_above(seen: FloatArray, sides: FloatArray, normal: FloatArray) -> BoolArray:
    """Whether the foot on the plane is within the triangle, for points seen from the corners."""
    return np.asarray(np.all([dot(normal, cross(side, a)) > 0.0 for side, a in zip(sides, seen, strict=True)], axis=0))


def _quotient(numerator: FloatArray, denominator: FloatArray) -> FloatArray:
    """Their quotient, inf where the denominator is 0."""
    safe = np.where(denominator > 0.0, denominator, 1.0)
    return np.where(denominator > 0.0, numerator / safe, np.inf)
