"""Vertices inserted on edges are rounded: whether the curve is still what it was."""

from collections.abc import Sequence

import numpy as np

from ..curve import Curve
from ..obstacle import Obstacle
from .clearance import clears
from .gap import minimal_gap

# Bound of the rounding errors of tail + t (head − tail), in units of the last place of the largest coordinate: one each
# of the difference, which may be twice as large, and of the product, and half a one of the sum.  That of t itself only
# moves the vertex along its edge.
UNITS = 2.5


def survives_rounding(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> bool:
    """Whether vertices that lie on edges but for rounding can move onto these without any contact.

    Then the curve with them and the curve without them are isotopic: no point moves by more than r, the rounding, and
    edges that are no neighbours are more than 2 r apart, and obstacles, which the curve does not touch, more than r
    from it (and a bit, for the rounding of that distance). In more than three dimensions there is nothing to keep.
    """
    if curve.dimension > 3:
        return True
    rounding = UNITS * np.spacing(np.abs(curve.vertices).max()) * np.sqrt(curve.dimension)
    return bool(minimal_gap(curve)[0] > 2.1 * rounding) and clears(curve, obstacles, float(1.1 * rounding))
