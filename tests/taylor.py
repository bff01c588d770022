"""Check derivatives by the order at which Taylor remainders vanish.

The remainder of a Taylor polynomial of degree d is O(t^(d+1)): on logarithmic axes its slope is 2 for a correct
first derivative and 3 for a correct second one.  A wrong derivative shows a slope of 1 or 2.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.curve import Curve
from mobius_flow.core.energies.energy import Energy, TwiceDifferentiable

WINDOW = 5  # consecutive steps that make one fit
ROUNDING = 1e-15  # remainders below this part of the function are ignored


def taylor_slope(
    function: Callable[[float], npt.ArrayLike], terms: Sequence[npt.ArrayLike], largest: float = 0.1, halvings: int = 20
) -> float:
    """Fit the order at which the Taylor remainder of a function f of a real variable, scalar or array, vanishes at 0.

    The remainder |f(t) − Σ terms[k] tᵏ/k!| is taken at t = largest/2ᵏ, with ``terms`` f(0), f'(0), f''(0), ... as far
    as they are to be checked; of all windows of five consecutive steps the straightest (on logarithmic axes) gives the
    slope, which leaves out steps that are too large for the asymptotics and those where rounding rules.

    Returns ``len(terms)``, within the error of the fit, if the terms are right, and inf if the remainder vanishes.
    """
    steps = largest * 0.5 ** np.arange(halvings + 1)
    remainders = np.array([_remainder(function, terms, float(t)) for t in steps])
    if np.count_nonzero(remainders) < WINDOW:
        return math.inf
    fits = [
        _line(np.log(steps[first : first + WINDOW]), np.log(remainders[first : first + WINDOW]))
        for first in range(len(steps) - WINDOW + 1)
        if remainders[first : first + WINDOW].all()
    ]
    return min(fits)[1] if fits else math.nan


def derivative_slope(energy: Energy, curve: Curve, direction: FloatArray, largest: float = 0.1) -> float:
    """Taylor slope of an energy's first derivative along ``direction``, shape (n, m); 2 if it is right."""
    value, derivative = energy.value_and_derivative(curve)
    return taylor_slope(_along(curve, direction, energy.value), [value, np.sum(derivative * direction)], largest)


def hessian_slope(energy: TwiceDifferentiable, curve: Curve, direction: FloatArray, largest: float = 0.1) -> float:
    """Taylor slope of an energy's second derivative along ``direction``, shape (n, m); 3 if it is right."""
    value, derivative = energy.value_and_derivative(curve)
    curvature = np.sum(direction * energy.hessian_product(curve, direction))
    terms = [value, np.sum(derivative * direction), curvature]
    return taylor_slope(_along(curve, direction, energy.value), terms, largest)


def _along(
    curve: Curve, direction: FloatArray, function: Callable[[Curve], npt.ArrayLike]
) -> Callable[[float], npt.ArrayLike]:
    return lambda t: function(curve.with_vertices(curve.vertices + t * direction))


def _remainder(function: Callable[[float], npt.ArrayLike], terms: Sequence[npt.ArrayLike], t: float) -> float:
    """Size of the remainder, 0 if it is nothing but the rounding of the function's values."""
    value = np.asarray(function(t), dtype=np.float64)
    remainder = value
    for k, term in enumerate(terms):
        remainder = remainder - np.asarray(term) * (t**k / math.factorial(k))
    size = float(np.linalg.norm(remainder))
    return size if size > ROUNDING * float(np.linalg.norm(value)) else 0.0


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    return float(np.linalg.norm(y - slope * x)), slope
