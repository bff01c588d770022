"""Polygons: vertices, connectivity, refinement, files."""

from .curve import Curve, at_edges, at_vertices, check_closed
from .mesh import Mesh
from .refine import refine

__all__ = ["Curve", "Mesh", "at_edges", "at_vertices", "check_closed", "refine"]
