"""Knots and links to start from: a table and its smooth shapes, torus knots, braids, drawings, satellites, arcs."""

from .braids import braid_closure, torus_knot
from .drawings import Drawing
from .formulas import FORMULAS, cable, double, freedman, lissajous_knot, overhand
from .inscribed import rounded
from .knot_type import Effort, KnotType, knot_type
from .names import ALIASES, HARD_UNKNOTS, KNOTS, UnknownKnotError, braid_word, knot, knot_names
from .scrambles import scramble
from .shapes import smooth_knot
