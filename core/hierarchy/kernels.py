"""Derivatives of the two kernels of the Möbius energy, 1/|d|² and log|d|, of any order and in any dimension."""

import numpy as np

from ..types import FloatArray
from .polynomials import Polynomials


def kernel_derivatives(table: Polynomials, d: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """∂^α 1/|d|² up to a degree and ∂^α log|d| up to two more, each of shape (monomials, k); d has shape (m, k).

    The logarithm itself, α = 0, is not needed and left 0.
    """
    s = _inverse_square(table, d, degree + 1)
    log = _logarithm(table, d, s, degree + 2)
    factorial = _factorials(table, degree + 2)
    return s[: table.size(degree)] * factorial[: table.size(degree)], log * factorial


def _inverse_square(table: Polynomials, d: FloatArray, degree: int) -> FloatArray:
    """Taylor coefficients s_α = ∂^α (1/|d|²)/α!, and a row of zeros at the end.

    From s |d + w|² = 1, in every degree: |d|² s_α + 2 Σ_i d_i s_{α−e_i} + Σ_i s_{α−2e_i} = 0.
    """
    s = np.zeros((table.size(degree) + 1, d.shape[1]))
    s[0] = 1.0 / np.einsum("ik,ik->k", d, d)
    slope = -2.0 * d * s[0]
    for monomials in table.of_degree[1 : degree + 1]:
        once = table.lower[:, monomials]
        twice = np.stack([np.where(row < 0, -1, lower[row]) for row, lower in zip(once, table.lower, strict=True)])
        s[monomials] = np.einsum("ik,iak->ak", slope, s[once]) - s[0] * s[twice].sum(axis=0)
    return s


def _logarithm(table: Polynomials, d: FloatArray, s: FloatArray, degree: int) -> FloatArray:
    """Taylor coefficients of log|d|, whose gradient is d/|d|²: γ_i log_γ = d_i s_{γ−e_i} + s_{γ−2e_i}, for any i."""
    size = table.size(degree)
    exponents = table.exponents[1:size]
    axis = np.argmax(exponents > 0, axis=1)
    once = table.lower[axis, np.arange(1, size)]
    twice = np.where(once < 0, -1, table.lower[axis, once])
    log = np.zeros((size, d.shape[1]))
    log[1:] = d[axis]
    log[1:] *= s[once]
    log[1:] += s[twice]
    log[1:] /= exponents[np.arange(size - 1), axis][:, None]
    return log


def _factorials(table: Polynomials, degree: int) -> FloatArray:
    """α!; shape (monomials, 1)."""
    factorial = np.cumprod(np.maximum(np.arange(degree + 1), 1)).astype(np.float64)
    return np.asarray(factorial[table.exponents[: table.size(degree)]].prod(axis=1)[:, None])
