"""The one shape of which it is certain that no motion leads lower: the circle, which every unknot can become."""

import numpy as np

from ...curve import Curve
from ...errors import CurveError
from ...knots import knot_type
from ...knots.alexander import signature
from ...messages import Message

IS_UNKNOT = Message("the curve is an unknot, and a circle has less energy")
MAY_BE_UNKNOT = Message(
    "the curve may be an unknot, for its Alexander polynomial is trivial, and a circle has less energy"
)
ROUND = 0.9  # of the area of the circle of the same length: coarse and uneven ones have that
MOST_VERTICES = 10_000  # of a curve whose type is looked at: a few seconds


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


def told_of_unknot(curve: Curve) -> Message | None:
    """Say that a curve is or may be an unknot, though it is no circle; None if it is one, or is knotted or a link."""
    alone = len(curve.mesh.component_sizes) == 1
    if not alone or curve.dimension != 3 or len(curve) > MOST_VERTICES or is_circle(curve):
        return None
    if not signature(curve).is_trivial:
        return None
    try:
        names = knot_type(curve).names
    except CurveError:  # a stuck curve may be so near to itself that no view tells which strand is in front
        names = ()
    if not names:
        return MAY_BE_UNKNOT
    return IS_UNKNOT if names == ("0_1",) else None
