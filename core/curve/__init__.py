"""Polygons: vertices, connectivity, refinement, files."""

from .curve import Curve
from .mesh import Mesh
from .refine import refine

__all__ = ["Curve", "Mesh", "refine"]
