"""Moves: what may act on a run between its steps; each is a class, made for each run, with settings as fields."""

from collections.abc import Callable, Sequence

from ..move import Move
from ..run import Run
from .balance import Balance
from .grow import Grow
from .hand import AwaitHand, Hold
from .hops import ON_A_FIXED_MESH, Hops
from .links import Composite, OpenKnots, SplitLinks
from .remesh import FinerMesh, Remesh
from .rest import CheckAccuracy, EscapeSaddle, Fallback, Settle
from .rope import GiveWay
from .starts import CoarseStart
from .untangling import Untangling

MOVES: Sequence[Callable[[Run], Move]] = (
    Hold,
    OpenKnots,
    Untangling,
    Grow,
    SplitLinks,
    CoarseStart,
    GiveWay,
    EscapeSaddle,
    Composite,
    Balance,
    FinerMesh,
    Settle,
    Fallback,
    Remesh,
    CheckAccuracy,
    AwaitHand,
    Hops,
)
"""In the order in which they are asked; before them `SymmetricStart`, where a symmetry is to be kept."""
