"""The least distance between strands of a curve, without a look at all pairs of vertices."""

import numpy as np
from scipy.spatial import cKDTree

from .curve import Curve
from .distances import arc_distance_of_vertices


def nearest_strands(curve: Curve, ratio: float, furthest: float = np.inf) -> float:
    """Least distance between vertices of different strands, inf if it is more than ``furthest``.

    Two vertices lie on different strands if they are more than ``ratio`` times further apart along the curve than in
    space, or on different components.  The radius of search doubles until it finds some: all pairs within the furthest
    would be too many where a long curve is tightly wound, as there the nearest strands are much nearer.
    """
    tree = cKDTree(curve.vertices)
    furthest = min(furthest, float(np.linalg.norm(np.ptp(curve.vertices, axis=0))))
    radius = curve.length / len(curve)
    while True:
        radius = min(2.0 * radius, furthest)
        i, j = tree.query_pairs(radius, output_type="ndarray").T
        distance = np.linalg.norm(curve.vertices[i] - curve.vertices[j], axis=1)
        distance = distance[arc_distance_of_vertices(curve, i, j) > ratio * distance]
        if distance.size:
            return float(distance.min())
        if radius >= furthest:
            return np.inf
