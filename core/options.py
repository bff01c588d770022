"""Options of a relaxation: frozen and checked when they are made."""

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from types import MappingProxyType
from typing import cast, get_args, get_type_hints

import numpy as np

from .errors import OptionError

MOST_QUADRATURE_POINTS = 16  # work grows with the square
EDGE_LENGTHS = ("auto", "equal", "keep")


_KINDS: Mapping[type, tuple[tuple[type, ...], str]] = MappingProxyType(  # what a value may be; NumPy's are welcome
    {
        int: ((Integral,), "a whole number"),
        float: ((Real,), "a number"),
        str: ((str,), "a name"),
        bool: ((bool, np.bool_), "True or False"),
    }
)


@dataclass(frozen=True, kw_only=True)
class RelaxOptions:
    """What `relax` is asked to do.

    Parameters
    ----------
    method
        Name of a descent method, see ``mobius_flow.core.descent.METHODS``.
    max_iterations
        Stop after this many accepted steps.
    tolerance
        Stop when the projected gradient's metric norm is at most ``tolerance * sqrt(E)``.
    vertices
        Number of vertices to refine to; None chooses it so that neighbouring vertices are nearer
        than strands (Section 6.1.3 of [RS21]).
    energy
        Name of the energy, see ``mobius_flow.core.energies.ENERGIES``; the barrier is added to every one.
    metric
        Name of the metric, see ``mobius_flow.core.metrics.METRICS``; None is the method's own.
    quadrature_points
        Gauss points per edge of the metric J_C; None takes the energy's own rule.
    penalty
        Weight α of the length penalty of the infeasible methods; None is their default.
    stability
        Tell whether a converged curve is a minimum: count the negative eigenvalues of the Lagrangian's Hessian.
    escape_saddles
        Do so, and go on downhill from a saddle.
    adaptive
        Split and collapse edges during the run, so that neighbours stay nearer than strands.  The number of vertices
        changes from iterate to iterate, which point keyframes cannot follow.
    resolve
        When a curve has converged but strands are nearer than its mesh resolves, go on with half as many vertices
        more, up to 3.5 times the first number.
    edge_lengths
        Targets ℓ⁰: "equal" within each component, "keep" those of the refined start, or "auto": equal unless they,
        or the gaps between edges, differ by more than 10:1, where evening them out would crumple the curve.

    Raises
    ------
    OptionError
        If a value is outside its range.
    """

    method: str = "lbfgs"
    max_iterations: int = 2000
    tolerance: float = 1e-4
    vertices: int | None = None
    energy: str = "moebius"
    metric: str | None = None
    quadrature_points: int | None = None
    penalty: float | None = None
    adaptive: bool = False
    resolve: bool = False
    edge_lengths: str = "auto"
    stability: bool = False
    escape_saddles: bool = False

    def __post_init__(self) -> None:
        self._check_types()
        if self.max_iterations < 0:
            raise OptionError(f"max_iterations is {self.max_iterations}; it must be 0 or more")
        if not (math.isfinite(self.tolerance) and self.tolerance > 0):
            raise OptionError(f"tolerance is {self.tolerance}; it must be a finite number above 0")
        if self.vertices is not None and self.vertices < 3:
            raise OptionError(f"vertices is {self.vertices}; it must be 3 or more")
        if self.quadrature_points is not None and not 1 <= self.quadrature_points <= MOST_QUADRATURE_POINTS:
            raise OptionError(
                f"quadrature_points is {self.quadrature_points!s:.40}; it must be from 1 to {MOST_QUADRATURE_POINTS}"
            )
        if self.penalty is not None and not (math.isfinite(self.penalty) and self.penalty > 0):
            raise OptionError(f"penalty is {self.penalty}; it must be a finite number above 0")
        if self.adaptive and self.edge_lengths != "auto":
            raise OptionError("an adaptive mesh makes its own edge_lengths; leave one of the two options out")
        if self.edge_lengths not in EDGE_LENGTHS:
            raise OptionError(f"edge_lengths is {self.edge_lengths!r}; choose one of {', '.join(EDGE_LENGTHS)}")

    def _check_types(self) -> None:
        for name, hint in get_type_hints(type(self)).items():
            value = getattr(self, name)
            kinds = get_args(hint) or (hint,)  # of "int | None" both
            if value is None and type(None) in kinds:
                continue
            types, noun = _KINDS[kinds[0]]
            # bool is a kind of int, but no number
            if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
                raise OptionError(f"{name} is {value!r:.40}; it must be {noun}")
            if isinstance(value, Real) and abs(cast(float, value)) > sys.float_info.max:
                raise OptionError(f"{name} is too large for a number of this program")
