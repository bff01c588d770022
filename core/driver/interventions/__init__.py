"""Changes made to a run between its steps; each `Intervention` is a class, made per run, with settings as fields."""

from collections.abc import Callable, Sequence

from ..run import Intervention, Run
from .balance import Balance
from .coarse_start import CoarseStart
from .fallback import CheckAccuracy, Fallback
from .grow import Grow
from .links import Composite, SplitLinks
from .remesh import FinerMesh, Remesh
from .rest import EscapeSaddle, Rest

INTERVENTIONS: Sequence[Callable[[Run], Intervention]] = (
    Grow,
    SplitLinks,
    CoarseStart,
    EscapeSaddle,
    Composite,
    Balance,
    FinerMesh,
    Rest,
    Fallback,
    Remesh,
    CheckAccuracy,
)
"""In the order in which they are asked."""

ON_A_FIXED_MESH: Sequence[Callable[[Run], Intervention]] = (SplitLinks, Fallback, CheckAccuracy)
"""The interventions in a trial, which neither changes the mesh nor looks for more at its end."""
