"""Knots and links to start from: the named table and its smooth shapes, torus knots, braids, drawings, satellites,
arcs.
"""

from .arcs import ARCS, overhand
from .closures import braid_closure
from .coded import coded_knot
from .drawings import Drawing
from .knot_type import KnotType, knot_type
from .lissajous import lissajous_knot
from .names import UnknownKnotError, braid_word, knot, knot_names
from .planar import diagram_knot
from .satellites import cable, double
from .scrambles import scramble
from .shapes import smooth_knot
from .table import ALIASES, HARD_UNKNOTS, KNOTS
from .torus import torus_knot

__all__ = [
    "ALIASES",
    "ARCS",
    "HARD_UNKNOTS",
    "KNOTS",
    "Drawing",
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
    "scramble",
    "smooth_knot",
    "torus_knot",
]
