"""Polygons: vertices, connectivity, refinement, files."""

from .curve import Curve, check_closed
from .mesh import Mesh
from .refine import refine

__all__ = ["Curve", "Mesh", "check_closed", "refine"]
