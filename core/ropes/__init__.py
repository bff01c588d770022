"""Ropes: made of curves that run through each other, and pulled tight."""

from .crossings import AXES, Crossing
from .separate import Separated, SeparateOptions, separate, separating
from .tighten import Strut, Tightened, TightenOptions, tighten, tightening
