"""Preconditioned conjugate gradients for systems of which only products are at hand."""

from collections.abc import Callable

import numpy as np

from ..deadline import check_time
from ..types import FloatArray

LinearMap = Callable[[FloatArray], FloatArray]


def conjugate_gradients(
    operator: LinearMap,
    precondition: LinearMap,
    right: FloatArray,
    enough: Callable[[float, float], bool],
    max_iterations: int,
) -> FloatArray:
    """Solve ``operator`` x = ``right``, for arrays of any shape.

    Parameters
    ----------
    operator
        Symmetric and positive definite.
    precondition
        Near its inverse, symmetric and positive definite too.
    enough
        Whether to stop, from rᵀz, the square of the preconditioned residual, and from xᵀ ``right``, which grows to the
        squared norm of the solution in the operator's inner product.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the operator is not positive definite, or the iterations do not suffice.
    """
    x = np.zeros_like(right)
    r, direction, last, square = right.copy(), np.zeros_like(right), 1.0, 0.0
    for _ in range(max_iterations):
        check_time()
        z = precondition(r)
        rho = float(np.sum(r * z))
        if enough(rho, square):
            return x
        direction = z + (rho / last) * direction
        image = operator(direction)
        step = rho / _positive(float(np.sum(direction * image)))
        x += step * direction
        r -= step * image
        square += step * rho
        last = rho
    raise np.linalg.LinAlgError(f"conjugate gradients need more than {max_iterations} iterations")


def relative(tolerance: float) -> Callable[[float, float], bool]:
    """Enough when the residual is small against the solution, both squared."""
    return lambda rho, square: rho <= tolerance**2 * square


def flexible_conjugate_gradients(
    operator: LinearMap,
    precondition: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
    right: FloatArray,
    enough: Callable[[list[float]], bool],
    max_iterations: int,
) -> FloatArray:
    """The same with a preconditioner that varies from iteration to iteration (Polak and Ribière's formula).

    Parameters
    ----------
    precondition
        From r to z and the residual to go on with: r itself, or r without a part that is of no consequence.
    enough
        Whether to stop, from the decrease of ½ xᵀ A x − xᵀ ``right`` in all iterations so far, twice each: these are
        what each took off the squared norm of the error.
    """
    x, direction, rho = np.zeros_like(right), np.zeros_like(right), 1.0
    r = last = right
    decreases: list[float] = []
    while not enough(decreases):
        if len(decreases) == max_iterations:
            raise np.linalg.LinAlgError(f"conjugate gradients need more than {max_iterations} iterations")
        check_time()
        z, r = precondition(r)
        direction = z + float(np.sum(z * (r - last))) / rho * direction
        rho, last = float(np.sum(r * z)), r
        if rho == 0.0:
            break
        image = operator(direction)
        curvature, slope = _positive(float(np.sum(direction * image))), float(np.sum(r * direction))
        x = x + slope / curvature * direction
        r = r - slope / curvature * image
        decreases.append(slope**2 / curvature)
    return x


def _positive(curvature: float) -> float:
    if not curvature > 0.0:
        raise np.linalg.LinAlgError("matrix is not positive definite: conjugate gradients met no positive curvature")
    return curvature
