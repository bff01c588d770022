"""What a relaxation yields, and how it ends."""

from dataclasses import dataclass
from enum import Enum

from .curve import Curve
from .types import FloatArray


class Status(Enum):
    """How far a relaxation is; every value but RUNNING is an end."""

    RUNNING = "running"
    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration_limit"
    STALLED = "stalled"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True, eq=False)
class Iterate:
    """One accepted curve of a relaxation, immutable, in the user's units.

    Attributes
    ----------
    index
        0 for the (refined) start, then 1, 2, ...
    curve
        The polygon; the iterates of a run have the same vertices unless the mesh is adaptive.
    energy
        The objective, moebius + barrier.
    gradient_norm
        Metric norm of the projected gradient at this curve (dimensionless).
    step_size
        Step size τ that led here, 0 for the start.
    path
        The motion from the previous iterate to this one: vertices, each (n, m), at the ends of its straight
        legs; the last is this curve, the start (the previous curve) is left out. Empty for the start, and where an
        adaptive mesh changes: there this is the previous curve with other vertices on its edges.
    certified
        True if every leg from the start of the run to here was proved free of contact.
    edge_length_error
        max |log ℓ/ℓ⁰| over the edges.
    negative_eigenvalues
        Of the Lagrangian's Hessian at a converged curve, if asked for: 0 at a minimum, more at a saddle.
    status
        RUNNING, or the reason why this is the last iterate.
    message
        One sentence for people, empty while running.
    """

    index: int
    curve: Curve
    energy: float
    gradient_norm: float
    step_size: float
    path: tuple[FloatArray, ...]
    certified: bool
    edge_length_error: float
    negative_eigenvalues: int | None = None
    status: Status = Status.RUNNING
    message: str = ""
