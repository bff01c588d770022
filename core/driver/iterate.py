"""What a relaxation yields."""

from dataclasses import dataclass

from ..arguments import checked_fields
from ..curve import Curve
from ..types import FloatArray


@checked_fields
@dataclass(frozen=True, eq=False)
class Iterate:
    """One accepted curve of a relaxation, immutable, in the user's units.

    Attributes
    ----------
    index
        0 for the (refined) start, then 1, 2, ...
    curve
        The polygon; the iterates of a run have the same vertices where the mesh is ``fixed``.
    energy
        The objective: the energy that is minimised, and the barrier.
    gradient_norm
        Norm of the projected gradient at this curve (dimensionless), in the metric that the method takes it in: that of
        this curve, or of one up to two steps before.
    step_size
        Step size τ that led here, 0 for the start and where the mesh changes.
    path
        The motion from the previous iterate to this one: vertices, each (n, m), at the ends of its straight
        legs; the last is this curve, the start (the previous curve) is left out. Empty for the start, and where the
        mesh changes: there this is the previous curve with other vertices on its edges.
    certified
        True if every leg from the start of the run to here was proved free of contact.
    edge_length_error
        max |log ℓ/ℓ⁰| over the edges.
    method
        Name of the method that took the step; another one than was asked for where that one was stuck.
    grown
        How many times the lengths of the start, as they were to be there, those of this curve are to be.
    pins
        Vertices of this curve that are held, counted from 0: those asked for, and those that cannot move between them.
    """

    index: int
    curve: Curve
    energy: float
    gradient_norm: float
    step_size: float
    path: tuple[FloatArray, ...]
    certified: bool
    edge_length_error: float
    method: str
    grown: float = 1.0
    pins: tuple[int, ...] = ()

    def __repr__(self) -> str:
        proved = "certified" if self.certified else "not certified"
        return f"<Iterate {self.index}: objective {self.energy:.9g}, gradient {self.gradient_norm:.2g}, {proved}>"
