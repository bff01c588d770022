"""The driver: options and a curve in, proved iterates and an outcome out; its decisions are `moves`."""

from ..io.trajectory import Iterate, Trajectory
from .hand import Hand
from .options import RelaxOptions
from .outcome import Outcome, Result, Status
from .relax import WithOutcome, finish, minimize, relax
from .run import Relaxation
from .words import TimeLeft
