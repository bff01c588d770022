"""What happens to a run beside its method's steps, one file each.

An intervention is made for one run and called after every event: nothing has happened yet, a step was taken, none was
found, or the run is about to end.  It answers with the event, told otherwise perhaps, or with what it does about it.
"""

from collections.abc import Callable, Sequence
from typing import Protocol

from ..events import Change, Event
from ..run import Run
from .balance import Balance
from .check_accuracy import CheckAccuracy
from .coarse_start import CoarseStart
from .composite import Composite
from .escape_saddle import EscapeSaddle
from .fallback import Fallback
from .finer_mesh import FinerMesh
from .grow import Grow
from .remesh import Remesh
from .split_links import SplitLinks


class Intervention(Protocol):
    """What is called after every event."""

    def __call__(self, event: Event) -> Event | Change:
        """Answer with the event as the next ones are to see it, or with a change, which ends the round."""


INTERVENTIONS: Sequence[Callable[[Run], Intervention]] = (
    Grow,
    SplitLinks,
    CoarseStart,
    EscapeSaddle,
    Composite,
    Balance,
    FinerMesh,
    Fallback,
    Remesh,
    CheckAccuracy,
)
"""In the order in which they are asked."""

ON_A_FIXED_MESH: Sequence[Callable[[Run], Intervention]] = (SplitLinks, Fallback, CheckAccuracy)
"""Those of a trial, which neither changes the mesh nor looks for more at its end."""
