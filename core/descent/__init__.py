"""Descent: what is minimised on which set (`problem`, `geometry`), in which directions, by which searches."""

from .methods import METHODS, Method
from .problem import Point, Problem
from .state import State
from .step import Leg, NoStep, Step

__all__ = ["METHODS", "Leg", "Method", "NoStep", "Point", "Problem", "State", "Step"]
