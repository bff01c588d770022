"""Symmetry: the isometries that map a curve to itself, their names, and their action on the vertices of a mesh."""

from .action import NO_SYMMETRY, Symmetry
from .group import IS_NAME, TOLERANCE, SymmetryGroup, symmetries
