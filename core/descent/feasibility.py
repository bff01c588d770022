"""The modified Newton method (42) of [RS21] that leads back to the constraints after a step."""

import numpy as np

from ..saddle import SaddleSolver
from ..types import FloatArray
from .problem import Point

TOLERANCE = 1e-11  # of the constraints' residual, relative error of edge lengths: far below any gap that can be proved
MAX_ITERATIONS = 15
CONTRACTION = 0.6  # slower than that, a shorter step is cheaper than more iterations


def restore(base: Point, vertices: FloatArray, level: FloatArray, solver: SaddleSolver | None = None) -> Point | None:
    """Find Q near ``vertices`` with Φ(Q) = ``level`` by Q ← Q − C(P)^† (Φ(Q) − level), P the base point.

    ``solver`` gives the pseudo-inverse; by default it is that of the base point's metric.  Returns None if the
    residual does not contract: the step was too long.
    """
    solver = base.saddle if solver is None else solver
    last = np.inf
    for _ in range(MAX_ITERATIONS):
        if not np.isfinite(vertices).all():
            return None
        point = base.problem.at(vertices)
        if not point.curve.edge_lengths.min() > 0.0:
            return None
        residual = point.residual - level
        error = float(np.max(np.abs(residual)))
        if error <= TOLERANCE:
            return point
        if not error <= CONTRACTION * last:
            return None
        last = error
        vertices = vertices - solver.pseudo_inverse(residual)
    return None
