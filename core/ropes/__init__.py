"""Ropes: made of curves that run through each other, and pulled tight."""

from .crossings import AXES
from .separate import Separated, SeparateOptions, separate, separating
from .tighten import Strut, Tightened, TightenOptions, tighten, tightening
