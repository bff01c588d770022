"""What happens to a run, and what an intervention does about it."""

from dataclasses import dataclass

from ..descent import Method, NoStep, Point, Step
from .outcome import Outcome


class Start:
    """Nothing has happened yet on this mesh."""


Event = Start | Step | NoStep | Outcome


@dataclass(frozen=True, eq=False)
class Change:
    """A step, perhaps, and then the same curve seen otherwise.

    Attributes
    ----------
    step
        A motion that comes first.
    further
        More of them after it, as far as there are iterations left.
    point
        The curve reached, in another problem: with other constraints, or on another mesh.
    method
        What takes the steps from now on.
    vertices
        Number of vertices from now on where no strands are near.
    """

    step: Step | None = None
    point: Point | None = None
    method: Method | None = None
    vertices: int | None = None
    further: tuple[Step, ...] = ()
