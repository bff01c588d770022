"""The algebra of Taylor expansions, and the derivatives of the kernels."""

from collections.abc import Callable

import numpy as np
import pytest
from mobius_flow.core.energies.hierarchy.polynomials import Polynomials, kernel_derivatives, polynomials

DIMENSION = pytest.mark.parametrize("m", [2, 3, 4])
DEGREE = 5


def coefficients(table: Polynomials, degree: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(table.size(degree), 3))


def evaluated(table: Polynomials, p: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Values of polynomials at x, shape (m,); shape (k,)."""
    return np.prod(x ** table.exponents[: len(p)], axis=1) @ p


@DIMENSION
def test_monomials(m: int) -> None:
    table = polynomials(m, DEGREE)
    degrees = table.exponents.sum(axis=1)
    assert len({tuple(alpha) for alpha in table.exponents}) == len(table.exponents)
    assert np.all(np.diff(degrees) >= 0)
    assert [table.size(k) for k in range(4)] == [1, 1 + m, (m + 1) * (m + 2) // 2, (m + 1) * (m + 2) * (m + 3) // 6]
    np.testing.assert_array_equal(table.signs[:, 0], (-1.0) ** degrees)


@DIMENSION
def test_products_are_products_of_values(m: int) -> None:
    table = polynomials(m, DEGREE)
    p, q, x = coefficients(table, 2, 1), coefficients(table, 3, 3), np.random.default_rng(5).normal(size=m)
    product = table.multiply(p, q, 5)
    np.testing.assert_allclose(evaluated(table, product, x), evaluated(table, p, x) * evaluated(table, q, x))
    np.testing.assert_array_equal(table.multiply(p, q, 4), product[: table.size(4)])
    a = np.random.default_rng(7).normal(size=(m, 3))
    linear = np.concatenate([np.zeros((1, 3)), a])
    np.testing.assert_allclose(table.multiply_linear(a, q), table.multiply(linear, q, 4))
    h, g = np.random.default_rng(11).normal(size=(2, m, 3))
    exponentials = (table.exponentials(each, DEGREE) for each in (h, g))
    np.testing.assert_allclose(table.multiply(*exponentials, DEGREE), table.exponentials(h + g, DEGREE))
    small = table.exponentials(1e-3 * h, DEGREE)
    np.testing.assert_allclose(evaluated(table, small, x), np.exp(x @ (1e-3 * h)), rtol=1e-13)


@DIMENSION
def test_contraction_is_the_transpose_of_multiplication(m: int) -> None:
    table = polynomials(m, DEGREE)
    t, p, q = coefficients(table, DEGREE, 1), coefficients(table, 2, 3), coefficients(table, 3, 5)
    contracted = table.contract(t, p, range(4), range(DEGREE + 1))
    np.testing.assert_allclose(np.sum(contracted * q, axis=0), np.sum(t * table.multiply(p, q, DEGREE), axis=0))
    some = table.contract(t, q, range(1, 3), range(2, 4))  # degrees
    t[: table.size(1)] = t[table.size(3) :] = 0.0
    np.testing.assert_allclose(some[1:], table.contract(t, q, range(3), range(DEGREE + 1))[1:])
    np.testing.assert_array_equal(some[0], 0.0)


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
