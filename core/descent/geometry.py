"""How lengths are kept decides where a method may go; `constrained` and `penalised` are the two ways of [RS21]."""

from typing import TYPE_CHECKING, Protocol

from ..curve import Curve
from ..metrics import InnerProduct
from ..saddle import TangentSpace
from ..types import FloatArray

if TYPE_CHECKING:
    from .problem import Point, Problem


class Geometry(Protocol):
    """The set that iterates lie on, its tangent spaces, and the ways from these back to the set."""

    @property
    def prescribes(self) -> bool:
        """Whether lengths and barycenters are prescribed, so that there are multipliers and a residual."""

    def value_and_derivative(self, problem: "Problem", curve: Curve) -> tuple[float, FloatArray]:
        """What is minimised on the set, and its derivative, shape (n, m)."""

    def tangent_space(self, problem: "Problem", curve: Curve, inner: InnerProduct) -> TangentSpace:
        """Where directions at a curve lie, with the metric there."""

    def residual(self, problem: "Problem", curve: Curve) -> FloatArray:
        """How far a curve is from the set; shape (rows of the constraints,)."""

    def retract(self, base: "Point", vertices: FloatArray, level: FloatArray, space: TangentSpace) -> "Point | None":
        """The point of the set, or of a level of the residual, that vertices near it are led to; None if too far.

        ``space`` has the metric of the way; its constraints are those of the base point.
        """

    def transport(self, point: "Point", u: FloatArray) -> FloatArray:
        """A vector of another tangent space moved to that of a point; shape (n, m)."""

    def weighted(self, penalty: float) -> "Geometry":
        """The same with another weight α of length errors; an OptionError if there is none."""
