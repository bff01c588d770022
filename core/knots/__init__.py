"""Knots and links to start from: torus knots, braid closures, diagrams, the named table, hard unknots, scrambles."""

from .closures import braid_closure
from .contacts import rope, spiral
from .lattice import lattice_closure
from .lifting import Drawing
from .names import UnknownKnotError, braid_word, knot, knot_names
from .planar import diagram_knot
from .scrambles import scramble
from .table import ALIASES, HARD_UNKNOTS, KNOTS
from .torus import torus_knot
from .unknots import hard_unknot, unknot_word

__all__ = [
    "ALIASES",
    "HARD_UNKNOTS",
    "KNOTS",
    "Drawing",
    "UnknownKnotError",
    "braid_closure",
    "braid_word",
    "diagram_knot",
    "hard_unknot",
    "knot",
    "knot_names",
    "lattice_closure",
    "rope",
    "scramble",
    "spiral",
    "torus_knot",
    "unknot_word",
]
