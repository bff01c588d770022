"""Descent: what is minimised on which set (`problem`, `methods`), in which directions, by which searches."""

from .methods import METHODS, Method
from .problem import Point, Problem
from .step import Leg, NoStep, SearchState, Step
