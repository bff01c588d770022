"""Polygons: vertices, connectivity, refinement, files."""

from .curve import MAKERS, Curve, at_edges, at_vertices, check_closed
from .mesh import Mesh, component_order, near_to_near
from .obstacle import MAX_COORDINATE, Obstacle
from .pins import NO_PINS, NOWHERE, TAUT, Pins, arcs, free_edges, holds, spans
from .refine import refine

__all__ = ["Curve", "Mesh", "at_edges", "at_vertices", "check_closed", "refine"]
