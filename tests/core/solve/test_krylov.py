"""Conjugate gradients against dense solves."""

import numpy as np
import pytest
from mobius_flow.core.solve.saddle.krylov import conjugate_gradients, flexible_conjugate_gradients, relative

RNG = np.random.default_rng(53)
FACTOR = RNG.normal(size=(30, 30))
MATRIX = FACTOR @ FACTOR.T + 0.1 * np.eye(30)
RIGHT = RNG.normal(size=(30, 3))


def product(x: np.ndarray) -> np.ndarray:
    return MATRIX @ x


def diagonal(r: np.ndarray) -> np.ndarray:
    return r / np.diag(MATRIX)[:, None]


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-10])
def test_solves(tolerance: float) -> None:
    x = conjugate_gradients(product, diagonal, RIGHT, relative(tolerance), 500)
    error = x - np.linalg.solve(MATRIX, RIGHT)
    assert np.sqrt(np.sum(error * product(error)) / np.sum(RIGHT * x)) < 100 * tolerance


def test_square_is_the_norm_of_the_solution() -> None:
    squares: list[float] = []

    def enough(rho: float, square: float) -> bool:
        squares.append(square)
        return rho < 1e-24

    x = conjugate_gradients(product, diagonal, RIGHT, enough, 500)
    assert squares == sorted(squares)
    assert squares[-1] == pytest.approx(np.sum(x * product(x)))


def test_flexible_with_a_preconditioner_that_varies() -> None:
    rng, decreases = np.random.default_rng(59), []

    def precondition(r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return diagonal(r) * (1.0 + 0.05 * rng.normal(size=(30, 1))), r

    def enough(values: list[float]) -> bool:
        decreases[:] = values
        return len(values) > 2 and sum(values[-2:]) < 1e-20

    x = flexible_conjugate_gradients(product, precondition, RIGHT, enough, 500)
    expected = np.linalg.solve(MATRIX, RIGHT)
    np.testing.assert_allclose(x, expected, atol=1e-7)
    assert sum(decreases) == pytest.approx(np.sum(RIGHT * expected))


def test_nothing_to_solve() -> None:
    zero = np.zeros((30, 3))
    assert not np.any(conjugate_gradients(product, diagonal, zero, relative(1e-3), 10))
    assert not np.any(flexible_conjugate_gradients(product, lambda r: (r, r), zero, lambda _: False, 10))


@pytest.mark.parametrize("flexible", [False, True])
def test_refusals(flexible: bool) -> None:
    def solve(matrix: np.ndarray, iterations: int) -> np.ndarray:
        if flexible:
            return flexible_conjugate_gradients(
                lambda x: matrix @ x, lambda r: (r, r), RIGHT, lambda _: False, iterations
            )
        return conjugate_gradients(lambda x: matrix @ x, lambda r: r, RIGHT, lambda *_: False, iterations)

    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        solve(-MATRIX, 10)
    with pytest.raises(np.linalg.LinAlgError, match="more than 4 iterations"):
        solve(MATRIX, 4)
