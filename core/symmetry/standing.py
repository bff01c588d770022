"""How a symmetric curve stands: its axis of highest order upright, and one of order two across."""

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from ..curve import Curve
from ..types import FloatArray
from .group import SymmetryGroup, multiplication, order_of

ACROSS = 0.1  # cosine of an angle that counts as a right one


def standing(curve: Curve, group: SymmetryGroup) -> FloatArray:
    """The rotation, shape (3, 3), that turns a curve's axis of highest order into the third axis.

    Without one of order three or more it is the direction in which the curve extends least. The second axis is one of
    order two if there is one across, and otherwise points to where the curve is farthest away.
    """
    points = curve.vertices - group.centre
    axes = list(_axes(group.matrices))
    order, up = max(axes, key=lambda each: each[0], default=(1, points[0]))
    if order < 3:
        up = np.linalg.svd(points, full_matrices=False)[2][2]
    flat = points - np.outer(points @ up, up)
    twofold = [axis for order, axis in axes if order == 2 and abs(axis @ up) < ACROSS]
    far = max([*twofold, *(-axis for axis in twofold)], key=lambda axis: float((flat @ axis).max()), default=None)
    second = flat[np.linalg.norm(flat, axis=1).argmax()] if far is None else far - (far @ up) * up
    second = second / np.linalg.norm(second)
    return np.array([np.cross(second, up), second, up])


def _axes(matrices: FloatArray) -> Iterator[tuple[int, FloatArray]]:
    """Orders and axes, unit vectors, of rotations and rotary reflections, except reflections in planes and points."""
    table = multiplication(matrices)
    for number, matrix in enumerate(matrices):
        order, sign = order_of(table, number), np.linalg.det(matrix)
        turn = Rotation.from_matrix(sign * matrix).as_rotvec()
        if order > 2 or (order == 2 and sign > 0.0):
            yield order, turn / np.linalg.norm(turn)
