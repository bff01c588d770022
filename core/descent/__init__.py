"""Descent: what is minimised on which set (`problem`, `methods`), in which directions, by which searches."""

from .hessian import soft_modes
from .line_searches import LineSearch, on_target
from .methods import METHODS, Method
from .problem import Point, Problem
from .step import Leg, NoStep, SearchState, Step, attempt, leg
from .task import Task, Units, check_refined
