"""The driver: options and a curve in, proved iterates and an outcome out; its decisions are `interventions`."""

from .hand import Hand
from .loop import Relaxation, WithOutcome
from .options import RelaxOptions
from .outcome import Outcome, Status
from .relax import Result, finish, minimize, relax
from .time_left import TimeLeft
from .trajectory import Iterate, Trajectory
