"""Polygons: vertices, connectivity, refinement, files."""

from .alignment import Alignment, Freedom, alignments
from .curve import MAKERS, Curve, at_edges, at_vertices, check_closed
from .distances import (
    STRAND_RATIO,
    arc_distance_of_pairs,
    arc_distance_of_points,
    arc_distances,
    arc_positions,
    near_by_octave,
    nearest_on_edges,
    nearest_strands,
    periods,
    points_at,
    vertex_positions,
)
from .measures import bending, bending_and_derivative, bending_radii, writhe_and_crossings
from .mesh import Mesh, component_order, near_to_near
from .obstacle import MAX_COORDINATE, Obstacle
from .pins import NO_PINS, NOWHERE, TAUT, Pins, arcs, free_edges, holds, spans
from .refine import (
    SPLIT,
    Resolution,
    affordable_pieces,
    arc_lengths,
    cubic_spline,
    evenly,
    graded_spacing,
    halved,
    interpolated,
    refine,
    refined_alike,
    sample_parameters,
    smoothed,
    subdivide,
)

__all__ = ["Curve", "Mesh", "at_edges", "at_vertices", "check_closed", "refine"]
