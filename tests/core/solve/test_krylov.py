"""Conjugate gradients against dense solves."""

import numpy as np
import pytest
from mobius_flow.core.solve.saddle.iterative import conjugate_gradients, relative, stopping

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
    x = conjugate_gradients(product, relative(diagonal, tolerance), RIGHT, 500)
    error = x - np.linalg.solve(MATRIX, RIGHT)
    assert np.sqrt(np.sum(error * product(error)) / np.sum(RIGHT * x)) < 100 * tolerance


def test_square_is_the_norm_of_the_solution() -> None:
    squares: list[float] = []

    def enough(rho: float, square: float) -> bool:
        squares.append(square)
        return rho < 1e-24

    x = conjugate_gradients(product, stopping(diagonal, enough), RIGHT, 500)
    assert squares == sorted(squares)
    assert squares[-1] == pytest.approx(np.sum(x * product(x)))


def test_a_preconditioner_may_vary() -> None:
    rng, seen = np.random.default_rng(59), list[float]()

    def precondition(r: np.ndarray, decreases: list[float]) -> tuple[np.ndarray, np.ndarray] | None:
        seen[:] = decreases
        if len(decreases) > 2 and sum(decreases[-2:]) < 1e-20:
            return None
        return diagonal(r) * (1.0 + 0.05 * rng.normal(size=(30, 1))), r

    x = conjugate_gradients(product, precondition, RIGHT, 500)
    expected = np.linalg.solve(MATRIX, RIGHT)
    np.testing.assert_allclose(x, expected, atol=1e-7)
    assert sum(seen) == pytest.approx(np.sum(RIGHT * expected))


def test_nothing_to_solve() -> None:
    assert not np.any(conjugate_gradients(product, relative(diagonal, 1e-3), np.zeros((30, 3)), 10))
    assert not np.any(conjugate_gradients(product, lambda r, _: (r, r), np.zeros((30, 3)), 10))


def solve(matrix: np.ndarray, iterations: int, *, indefinite: bool = False) -> np.ndarray:
    return conjugate_gradients(lambda x: matrix @ x, lambda r, _: (r, r), RIGHT, iterations, indefinite=indefinite)


def test_refusals() -> None:
    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        solve(-MATRIX, 10)
    with pytest.raises(np.linalg.LinAlgError, match="more than 4 iterations"):
        solve(MATRIX, 4)


def test_an_indefinite_operator_is_left_with_a_direction_of_descent() -> None:
    """The steepest one at first, and what was found so far later, or after the last iteration."""
    np.testing.assert_array_equal(solve(-MATRIX, 10, indefinite=True), RIGHT)
    part = solve(MATRIX, 4, indefinite=True)
    assert 0 < np.sum(RIGHT * part) < np.sum(RIGHT * np.linalg.solve(MATRIX, RIGHT))
    mixed = np.diag(np.where(np.arange(30) < 29, 1.0 + np.arange(30), -1e-3))
    assert np.sum(RIGHT * solve(mixed, 100, indefinite=True)) > 0
