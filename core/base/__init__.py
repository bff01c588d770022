"""What every room stands on: errors, messages, checked arguments, files, time, threads, types of arrays."""

from .arguments import Option, check_known, check_number, checked, checked_fields, declared, is_list, number
from .deadline import TimeIsUp, TimeLimit, check_time, termination_raises
from .errors import (
    CurveError,
    CurveFileError,
    CurveOptionError,
    MobiusFlowError,
    OptionError,
    OutputError,
    Place,
    choice,
    counted,
    likeliest,
    reason_of,
    shown,
    wrong_suffix,
)
from .files import atomic_write, check_place, status_of, write_file
from .messages import COMPONENT, EDGE, OBSTACLE, OF_GOAL, VERTEX, VERTEX_COUNT, Message, Sentence, joined
from .plugins import Table
from .threads import BLAS
from .tolerances import BULK, ENERGY_ROUNDING, MIN_GAP, PLANE_ROUNDING, PLANE_UNDERFLOW
from .types import TINY, BoolArray, ComplexArray, FloatArray, IntArray, column_cross, column_dot, dot, frozen, real
