"""What happens to a run, and what an intervention does about it."""

from dataclasses import dataclass

from ..curve.refine import Resolution
from ..descent import Method, NoStep, Point, Step
from .outcome import Outcome


class Start:
    """Nothing has happened yet on this mesh."""


Event = Start | Step | NoStep | Outcome


@dataclass(frozen=True, eq=False)
class Change:
    """Steps, perhaps, and then the same curve seen otherwise.

    Attributes
    ----------
    steps
        Motions that come first.
    point
        The curve reached, in another problem: with other constraints, or on another mesh.
    method
        What takes the steps from now on.
    resolution
        How long edges may be from now on.
    """

    steps: tuple[Step, ...] = ()
    point: Point | None = None
    method: Method | None = None
    resolution: Resolution | None = None
