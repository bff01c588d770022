"""Vertices inserted on edges are rounded: whether the curve is still what it was."""

from collections.abc import Sequence

import numpy as np

from ..curve import Curve
from ..obstacle import Obstacle
from .clearance import clears
from .folds import folds
from .gap import minimal_gap, scaled_points, squared_segment_distances

# Bound of the rounding errors of tail + t (head − tail), in units of the last place of the largest coordinate: one each
# of the difference, which may be twice as large, and of the product, and half a one of the sum.  That of t itself only
# moves the vertex along its edge.
UNITS = 2.5


def survives_rounding(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> bool:
    """Whether vertices that lie on edges but for rounding can move onto these without any contact.

    Then the curve with them and the curve without them are isotopic: no point moves by more than r, the rounding, and
    what must not meet, edges that are no neighbours and `folds`, is more than 2 r apart, and obstacles, which the curve
    does not touch, more than r from it (and a bit, for the rounding of that distance). In more than three dimensions
    there is nothing to keep.
    """
    if curve.dimension > 3:
        return True
    rounding = UNITS * np.spacing(np.abs(curve.vertices).max()) * np.sqrt(curve.dimension)
    nearest = min(minimal_gap(curve)[0], _fold_gap(curve))
    return bool(nearest > 2.1 * rounding) and clears(curve, obstacles, float(1.1 * rounding))


def _fold_gap(curve: Curve) -> float:
    """The smallest distance of a vertex from the segment that it must not lie on; infinite if there is none."""
    points, unit = scaled_points(curve)
    squares = squared_segment_distances(points, folds(curve.mesh))
    return float(np.ldexp(np.sqrt(np.min(squares, initial=np.inf)), unit))
