"""Options of a relaxation: frozen and checked when they are made."""

import math
from dataclasses import dataclass

from .errors import OptionError


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

    Raises
    ------
    OptionError
        If a value is outside its range.
    """

    method: str = "lbfgs"
    max_iterations: int = 2000
    tolerance: float = 1e-4
    vertices: int | None = None

    def __post_init__(self) -> None:
        if self.max_iterations < 0:
            raise OptionError(f"max_iterations is {self.max_iterations}; it must be 0 or more")
        if not (math.isfinite(self.tolerance) and self.tolerance > 0):
            raise OptionError(f"tolerance is {self.tolerance}; it must be a finite number above 0")
        if self.vertices is not None and self.vertices < 3:
            raise OptionError(f"vertices is {self.vertices}; it must be 3 or more")
