"""The mathematics of Möbius Flow: NumPy and SciPy only.

`relax` yields the iterates of a relaxation; `minimize` runs it to its end.
"""

from .curve import Curve, Mesh
from .curve.io import read_curve, write_curve
from .descent import METHODS
from .energies import MoebiusEnergy, Objective
from .errors import CurveError, CurveFileError, MobiusFlowError, OptionError
from .iterate import Iterate, Status
from .options import RelaxOptions
from .relax import Result, minimize, relax
from .trajectory import Trajectory

__all__ = [
    "METHODS",
    "Curve",
    "CurveError",
    "CurveFileError",
    "Iterate",
    "Mesh",
    "MobiusFlowError",
    "MoebiusEnergy",
    "Objective",
    "OptionError",
    "RelaxOptions",
    "Result",
    "Status",
    "Trajectory",
    "minimize",
    "read_curve",
    "relax",
    "write_curve",
]
