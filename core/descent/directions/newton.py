"""Newton's direction on the constraint manifold, by conjugate gradients that the metric preconditions."""

import numpy as np

from ...deadline import check_time
from ...saddle import TangentSpace
from ...types import FloatArray
from ..hessian import LinearMap
from ..problem import Point


def projected_conjugate_gradient(
    operator: LinearMap, right: FloatArray, space: TangentSpace, tolerance: float, max_iterations: int
) -> FloatArray:
    """Solve ⟨operator w − right, v⟩ = 0 for all tangent v, for tangent w, preconditioned by the metric.

    Steihaug's rule: on a direction of negative curvature the iteration ends with what it has (the first time with
    that direction's steepest-descent step), so the result is a direction of descent of the quadratic model.

    Parameters
    ----------
    operator
        Symmetric, (n, m) to (n, m).
    right
        Covector, shape (n, m).
    space
        Projects and preconditions; its norm measures the residual.
    tolerance
        Relative residual at which to stop.
    """
    w = np.zeros_like(right)
    residual = right.copy()
    z = space.gradient(residual)[0]
    square = float(np.sum(residual * z))
    bound = tolerance**2 * square
    direction = z
    for _ in range(max_iterations):
        if not square > bound:
            break
        check_time()
        image = operator(direction)
        curvature = float(np.sum(direction * image))
        if curvature <= 0.0:
            return w if np.any(w) else direction
        step = square / curvature
        w = w + step * direction
        residual = residual - step * image
        z = space.gradient(residual)[0]
        square, last = float(np.sum(residual * z)), square
        direction = z + (square / last) * direction
    return w


def newton_direction(point: Point, hessian: LinearMap, tolerance: float, max_iterations: int = 200) -> FloatArray:
    """Tangent w with (D²L w + DE) orthogonal to the tangent space, by projected conjugate gradients."""
    return projected_conjugate_gradient(hessian, -point.derivative, point.tangent_space, tolerance, max_iterations)
