"""Knots and links to start from: torus knots, braid closures, the named table, hard unknots, scrambles."""

from .closures import braid_closure
from .contacts import rope, spiral
from .lattice import lattice_closure
from .names import UnknownKnotError, braid_word, knot
from .scrambles import scramble
from .table import ALIASES, KNOTS
from .torus import torus_knot
from .unknots import hard_unknot, unknot_word

__all__ = [
    "ALIASES",
    "KNOTS",
    "UnknownKnotError",
    "braid_closure",
    "braid_word",
    "hard_unknot",
    "knot",
    "lattice_closure",
    "rope",
    "scramble",
    "spiral",
    "torus_knot",
    "unknot_word",
]
