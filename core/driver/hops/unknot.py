"""The one shape of which it is certain that no motion leads lower: the circle, which every unknot can become."""

import numpy as np

from ...curve import Curve
from ...knots.recognition import Unknotted, unknotted

ROUND = 0.9  # of the area of the circle of the same length: coarse and uneven ones have that
MOST_VERTICES = 10_000  # of a curve whose type is looked at: a few seconds
IS_UNKNOT = "the curve is an unknot, so that the circle has less energy"
MAY_BE_UNKNOT = "the curve may be an unknot, for its Alexander polynomial is trivial, and the circle have less energy"


def is_circle(curve: Curve) -> bool:
    """Whether a curve is one component and a round circle, but for what its vertices make of it.

    By the isoperimetric inequality L² ≥ 4π |A|, A = ½ ∮ γ ∧ dγ the bivector of the areas of its shadows, in all
    dimensions; only once round the circle are the two equal.
    """
    if len(curve.mesh.component_sizes) > 1:
        return False
    moments = (curve.midpoints - curve.midpoints.mean(axis=0)).T @ curve.edge_vectors
    area = np.linalg.norm(moments - moments.T) / np.sqrt(8.0)
    return bool(4.0 * np.pi * area > ROUND * curve.length**2)


def told_of_unknot(curve: Curve) -> str | None:
    """Say that a curve at a minimum could become a circle, if it is not one and is or may be an unknot."""
    if curve.dimension != 3 or len(curve) > MOST_VERTICES or is_circle(curve):
        return None
    return {Unknotted.YES: IS_UNKNOT, Unknotted.MAYBE: MAY_BE_UNKNOT}.get(unknotted(curve))
