"""The mathematics of Möbius Flow, with NumPy and SciPy.

`relax` yields the iterates of a relaxation; `minimize` runs it to its end.
"""

from .curve import Curve, Mesh
from .curve.io import knot_list, read_curve, write_curve
from .descent import METHODS
from .driver import Hand, Iterate, Outcome, RelaxOptions, Result, Status, Trajectory, WithOutcome, minimize, relax
from .energies import MoebiusEnergy, Objective
from .errors import CurveError, CurveFileError, MobiusFlowError, OptionError
from .morphing import NoMotionError, morph
from .obstacle import Obstacle
from .obstacle_files import read_obstacle
from .task import Task

__all__ = [
    "METHODS",
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
    "knot_list",
    "minimize",
    "morph",
    "read_curve",
    "read_obstacle",
    "relax",
    "write_curve",
]
