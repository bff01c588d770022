"""Knots and links to start from: the named table and its smooth shapes, torus knots, braids, drawings, satellites,
arcs.
"""

from .arcs import ARCS, overhand
from .closures import braid_closure
from .coded import FORMATS, WRITTEN_FORMATS, coded_knot
from .contacts import rope, spiral
from .drawings import Drawing
from .knot_type import KnotType, knot_type
from .lattice import lattice_closure
from .lissajous import lissajous_knot
from .names import UnknownKnotError, braid_word, knot, knot_names
from .planar import diagram_knot
from .satellites import cable, double
from .scrambles import scramble
from .shapes import smooth_knot
from .table import ALIASES, HARD_UNKNOTS, KNOTS
from .torus import torus_knot
from .unknots import hard_unknot, unknot_word

__all__ = [
    "ALIASES",
    "ARCS",
    "FORMATS",
    "HARD_UNKNOTS",
    "KNOTS",
    "WRITTEN_FORMATS",
    "Drawing",
    "KnotType",
    "UnknownKnotError",
    "braid_closure",
    "braid_word",
    "cable",
    "coded_knot",
    "diagram_knot",
    "double",
    "hard_unknot",
    "knot",
    "knot_names",
    "knot_type",
    "lattice_closure",
    "lissajous_knot",
    "overhand",
    "rope",
    "scramble",
    "smooth_knot",
    "spiral",
    "torus_knot",
    "unknot_word",
]
