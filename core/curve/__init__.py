"""Polygons: vertices, connectivity, refinement, files."""

from .curve import Curve
from .mesh import Mesh

__all__ = ["Curve", "Mesh"]
