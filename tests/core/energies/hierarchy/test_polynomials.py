"""The derivatives of the kernels; expansions made of them are tried in `test_energy`."""

from collections.abc import Callable

import numpy as np
import pytest
from mobius_flow.core.energies.hierarchy.polynomials import kernel_derivatives, polynomials

DIMENSION = pytest.mark.parametrize("m", [2, 3, 4])
DEGREE = 5


@DIMENSION
@pytest.mark.parametrize("k", [0, 1])
def test_kernel_derivatives_are_the_taylor_coefficients(m: int, k: int) -> None:
    kernel: Callable[[np.ndarray], float] = [lambda x: 1 / (x @ x), lambda x: 0.5 * np.log(x @ x)][k]
    table = polynomials(m, DEGREE)
    d, w = np.random.default_rng(23).normal(size=(2, m))
    d *= 2.0 / np.linalg.norm(d)
    derivatives = kernel_derivatives(table, d[:, None], DEGREE - 2)[k]
    degree = DEGREE - 2 + 2 * k
    errors = []
    for t in (0.04, 0.02):
        series = np.sum(derivatives * table.exponentials(t * w[:, None], degree))
        errors.append(abs(kernel(d + t * w) - (kernel(d) if k == 1 else 0.0) - series))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(degree + 1, abs=0.3)
