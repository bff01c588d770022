"""Symmetry: the isometries that map a curve to itself, their names, and their action on the vertices of a mesh."""

from .action import NO_SYMMETRY, Symmetry
from .finding import TOLERANCE, symmetries
from .group import SymmetryGroup
from .names import IS_NAME
from .standing import standing

__all__ = ["IS_NAME", "NO_SYMMETRY", "TOLERANCE", "Symmetry", "SymmetryGroup", "standing", "symmetries"]
