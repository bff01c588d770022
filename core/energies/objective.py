"""The objective that `relax` descends on: an energy, the barrier of its near pairs, and further terms."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, cast

import numpy as np
import scipy.sparse as sp

from ..base import FloatArray, OptionError, checked_fields
from ..curve import Curve, Obstacle
from .barrier import Barrier, replaced_pairs
from .energy import Approximate, Energy, LocalTerm, Stiff, Term, scale_exponent
from .moebius import MoebiusEnergy
from .pull import Pull
from .repulsion import Repulsion
from .rope import Rope


class Weighted(NamedTuple):
    """A term and its weight in an objective."""

    term: Term
    weight: float = 1.0


@checked_fields
@dataclass(frozen=True)
class Objective:
    """A sum of terms: a C² function of the vertices, infinite where edges touch each other or an obstacle.

    A term has a name, a value and a derivative (`Term`). Other features of the objective depend on the abilities of its
    terms: a second derivative (`LocalTerm`), stiffness for the metric (`Stiff`), an attribute ``scale_exponent`` or
    ``moebius_invariant``.
    """

    energy: Energy = field(default_factory=MoebiusEnergy)  #: of the curve alone
    barrier: Barrier | None = field(default_factory=Barrier)  #: infinite where edges touch; None for none
    further: tuple[Weighted, ...] = ()  #: all other terms with their weights, such as the repulsion of obstacles

    @classmethod
    def of(
        cls, energy: Energy, obstacles: Iterable[Obstacle] = (), further: Iterable[Weighted] = (), barrier: bool = True
    ) -> "Objective":
        """An energy among obstacles, in the units of curves; the barrier replaces what the energy contains of it."""
        near = Barrier(replaces_midpoint=energy.contains_midpoint_pairs) if barrier else None
        return cls(energy, near, (*map(Weighted, Repulsion.of(obstacles)), *further))

    @property
    def terms(self) -> tuple[Term, ...]:
        """The energy, to which the barrier belongs, and all further terms."""
        return (self.energy, *(term for term, _ in self.further))

    @property
    def pull(self) -> Pull | None:
        """The pull of a hand, if one holds the curve."""
        return next((term for term, _ in self.further if isinstance(term, Pull)), None)

    @property
    def rope(self) -> Rope | None:
        """The barrier of a rope, if the curve is one."""
        return next((term for term, _ in self.further if isinstance(term, Rope)), None)

    def having(self, kind: type[Term], term: Term | None) -> "Objective":
        """The same with another term of some kind, such as the pull of a hand or a rope's barrier, or none."""
        others = tuple(each for each in self.further if not isinstance(each.term, kind))
        return replace(self, further=others if term is None else (*others, Weighted(term)))

    @property
    def sees_size(self) -> bool:
        """Whether it changes, or may change, when the curve is scaled."""
        return any(scale_exponent(term) != 0.0 for term in self.terms)

    @property
    def is_assembled(self) -> bool:
        """Whether the second derivative comes as a matrix too."""
        return self.without_hessian is None and hasattr(self.energy, "hessian")

    @property
    def without_hessian(self) -> Term | None:
        """The first term that has no second derivative."""
        local = (term for term, _ in self.further if not isinstance(term, LocalTerm))
        return next(local, None) if hasattr(self.energy, "hessian_product") else self.energy

    def frozen_at(self, curve: Curve) -> "Objective":
        """The objective for a search from a curve: approximations stay the same for everything near it."""
        energy, *others = (term.frozen_at(curve) if isinstance(term, Approximate) else term for term in self.terms)
        if all(a is b for a, b in zip((energy, *others), self.terms, strict=True)):
            return self
        further = tuple(each._replace(term=term) for each, term in zip(self.further, others, strict=True))
        return replace(self, energy=cast(Energy, energy), further=further)

    def value(self, curve: Curve) -> float:
        """The objective at the curve."""
        return float(sum(weight * term.value(curve) for term, weight in self._summands(curve)))

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """The objective and its derivative with respect to the vertices, shape (n, m)."""
        value, derivative = 0.0, np.zeros_like(curve.vertices)
        for term, weight in reversed(self._summands(curve)):  # the energy, which takes most of the time, is the first
            more, further = term.value_and_derivative(curve)
            value, derivative = value + weight * more, derivative + weight * further
            if not np.isfinite(value):
                break
        return value, derivative

    def hessian(self, curve: Curve) -> FloatArray:
        """Second derivative of an assembled one, symmetric, (n·m, n·m), in the order of ``vertices.ravel()``."""
        self._check_hessian()
        energy, *local = self._summands(curve)
        matrix: FloatArray = cast(Any, energy.term).hessian(curve)
        for term, weight in local:
            part = cast(LocalTerm, term).sparse_hessian(curve).tocoo()
            matrix[part.coords] += weight * part.data
        return matrix

    def hessian_product(self, curve: Curve, v: FloatArray) -> FloatArray:
        """The second derivative times ``v`` of shape (n, m), without forming the matrix; shape (n, m)."""
        self._check_hessian()
        parts = (weight * cast(LocalTerm, term).hessian_product(curve, v) for term, weight in self._summands(curve))
        return np.asarray(sum(parts, np.zeros_like(v)))

    def stiffness(self, curve: Curve) -> sp.sparray | None:
        """The form that the metric needs in addition, so that steps are not too long for some term; shape (n, n)."""
        forms = [weight * term.stiffness(curve) for term, weight in self.further if isinstance(term, Stiff)]
        return sp.csr_array(sum(forms[1:], forms[0])) if forms else None

    def clearance(self, curve: Curve) -> FloatArray:
        """The distance from each edge of a wall that would act as the nearest obstacle does; shape (edges,)."""
        nowhere = np.full(curve.mesh.edges, np.inf)
        walls = (term.clearance(curve) for term in self.terms if isinstance(term, Repulsion))
        return np.asarray(np.min([nowhere, *walls], axis=0))

    def _summands(self, curve: Curve) -> tuple[Weighted, ...]:
        """The terms, energy first; energy that the barrier takes away is never added: rounding would grow like 1/g²."""
        energy, barrier = self.energy, self.barrier
        if barrier is not None and barrier.replaces_midpoint:
            energy = cast(Any, energy).leaving_out(replaced_pairs(curve))
            barrier = replace(barrier, left_out=True)
        return (Weighted(energy), *(() if barrier is None else [Weighted(barrier)]), *self.further)

    def _check_hessian(self) -> None:
        lacking = self.without_hessian
        if lacking is not None:
            raise OptionError(f"{lacking.name!r} has no second derivative; choose another energy, term or method")
