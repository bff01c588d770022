"""Where a rope presses on itself: a map of contacts, arc by arc, and the forces at its vertices."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ..base.types import FloatArray
from ..curve import Curve
from .figure import Figure, Stroke

SIZE, MARGIN = 360.0, 12.0  # points
FRAME, CONTACT = "#8c8c8c", "#1f4e8c"


def contact_map(curve: Curve, struts: Sequence[tuple[int, int, float]]) -> Figure:
    """A dot, whose area is the force, for each two edges that press on each other, by their places along the rope.

    Both axes run along all components, with lines where one begins.  Each contact is there twice, by either edge first.
    """
    ends = np.cumsum(curve.edge_lengths)
    place = MARGIN + (ends - 0.5 * curve.edge_lengths) * (SIZE / ends[-1])
    starts = np.append(0.0, np.cumsum(curve.component_lengths)) * (SIZE / ends[-1]) + MARGIN
    low, high = MARGIN, MARGIN + SIZE
    figure = Figure((SIZE + 2.0 * MARGIN,) * 2, ())
    for x in starts:
        for line in ([[x, low], [x, high]], [[low, x], [high, x]]):
            figure.strokes.append(Stroke(np.array(line), 0.6, FRAME))
    largest = max((force for *_, force in struts), default=1.0)
    dot = np.array([[-0.005, 0.0], [0.005, 0.0]])  # with round ends
    for edge, other, force in struts:
        for x, y in pairwise((place[edge], place[other], place[edge])):
            figure.strokes.append(Stroke(dot + np.array([x, y]), 5.0 * (force / largest) ** 0.5, CONTACT))
    return figure


def contact_forces(curve: Curve, struts: Sequence[tuple[int, int, float]], radius: float) -> FloatArray:
    """Force per length that presses on the rope at each vertex, relative to its tension over its radius; (n,)."""
    forces = np.zeros(len(curve.edge_lengths))
    for *edges, force in struts:
        forces[edges] += radius * force
    at_ends = np.stack([curve.mesh.tails, curve.mesh.heads])
    pressing, lengths = (np.bincount(at_ends.ravel(), np.tile(x, 2), len(curve)) for x in (forces, curve.edge_lengths))
    return np.asarray(pressing / lengths)
