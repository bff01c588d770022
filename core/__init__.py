"""The mathematics of Möbius Flow, with NumPy and SciPy.

`relax` yields the iterates of a relaxation; `minimize` runs it to its end.
"""

from .base.errors import CurveError, CurveFileError, MobiusFlowError, OptionError
from .curve import Curve, Mesh, Obstacle
from .descent import METHODS, Task
from .driver import Hand, Outcome, RelaxOptions, Result, Status, WithOutcome, minimize, relax
from .driver.audit import Audit, audit
from .driver.morph import NoMotionError, morph
from .energies import MoebiusEnergy, Objective
from .io import knot_list, read_curve, write_curve
from .io.obstacles import read_obstacle
from .io.trajectory import Iterate, Trajectory
from .ropes import separate, tighten

__all__ = [
    "METHODS",
    "Audit",
    "Curve",
    "CurveError",
    "CurveFileError",
    "Hand",
    "Iterate",
    "Mesh",
    "MobiusFlowError",
    "MoebiusEnergy",
    "NoMotionError",
    "Objective",
    "Obstacle",
    "OptionError",
    "Outcome",
    "RelaxOptions",
    "Result",
    "Status",
    "Task",
    "Trajectory",
    "WithOutcome",
    "audit",
    "knot_list",
    "minimize",
    "morph",
    "read_curve",
    "read_obstacle",
    "relax",
    "separate",
    "tighten",
    "write_curve",
]
