"""Knots and links to start from: a table and its smooth shapes, torus knots, braids, drawings, satellites, arcs."""

from .closed_braids import braid_closure, torus_knot
from .drawings import Drawing
from .inscribed import rounded
from .knot_type import Effort, KnotType, knot_type
from .names import UnknownKnotError, braid_word, knot, knot_names
from .parametric import ARCS, lissajous_knot, overhand
from .planar import coded_knot, diagram_knot
from .satellites import cable, double
from .scrambles import scramble
from .shapes import smooth_knot
from .table import ALIASES, HARD_UNKNOTS, KNOTS

__all__ = [
    "ALIASES",
    "ARCS",
    "HARD_UNKNOTS",
    "KNOTS",
    "Drawing",
    "Effort",
    "KnotType",
    "UnknownKnotError",
    "braid_closure",
    "braid_word",
    "cable",
    "coded_knot",
    "diagram_knot",
    "double",
    "knot",
    "knot_names",
    "knot_type",
    "lissajous_knot",
    "overhand",
    "rounded",
    "scramble",
    "smooth_knot",
    "torus_knot",
]
