"""Truncated polynomials in m variables ξ, many at once: the algebra of Taylor expansions, and the kernels' expansions.

A polynomial is an array of coefficients of the monomials ξ^α sorted by degree; k polynomials have shape (monomials, k),
and the number of monomials gives the degree.  With ξ for ∇, p(∇) applied to a function of d makes sums of
its values out of its derivatives: Σ_I w_I φ(d + u_I) is p(∇) φ with p = Σ_I w_I exp⟨u_I, ξ⟩, the *moments* of w.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations_with_replacement, pairwise

import numpy as np

from ...base import FloatArray, IntArray, column_dot


@dataclass(frozen=True)
class Polynomials:
    """Polynomials in ``dimension`` variables of degree at most ``degree``; `polynomials` makes each only once."""

    dimension: int
    degree: int

    @cached_property
    def exponents(self) -> IntArray:
        """The multi-index α of each monomial; shape (monomials, m)."""
        axes = range(self.dimension)
        factors = [chosen for k in range(self.degree + 1) for chosen in combinations_with_replacement(axes, k)]
        return np.array([[chosen.count(axis) for axis in axes] for chosen in factors])

    @cached_property
    def of_degree(self) -> tuple[slice, ...]:
        """The monomials of each degree."""
        ends = np.searchsorted(self.exponents.sum(axis=1), np.arange(self.degree + 2))
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    def size(self, degree: int) -> int:
        """Number of monomials up to a degree."""
        return int(self.of_degree[degree].stop)

    @cached_property
    def signs(self) -> FloatArray:
        """(−1)^|α|, which turns p(ξ) into p(−ξ); shape (monomials, 1)."""
        return np.where(self.exponents.sum(axis=1) % 2 == 0, 1.0, -1.0)[:, None]

    @cached_property
    def sums(self) -> IntArray:
        """The place of α + β; shape (monomials, monomials), −1 where the degree is too high."""
        return self._places(self.exponents[:, None] + self.exponents)

    @cached_property
    def lower(self) -> IntArray:
        """The place of α less one in one variable; shape (m, monomials), −1 where α has none."""
        return self._places(self.exponents - np.eye(self.dimension, dtype=np.intp)[:, None])

    def _places(self, exponents: IntArray) -> IntArray:
        """Places of multi-indices, shape (..., m); −1 for those that are not among ours."""
        place = {tuple(alpha): k for k, alpha in enumerate(self.exponents.tolist())}
        flat = [place.get(tuple(alpha), -1) for alpha in exponents.reshape(-1, self.dimension).tolist()]
        return np.array(flat, dtype=np.intp).reshape(exponents.shape[:-1])

    def exponentials(self, h: FloatArray, degree: int) -> FloatArray:
        """exp⟨h, ξ⟩ up to a degree, coefficients h^α/α!; shape (monomials, k) from (m, k)."""
        power = np.empty((self.size(degree), h.shape[1]))
        power[0] = 1.0
        for k in range(1, len(power)):
            axis = int(np.argmax(self.exponents[k] > 0))
            np.multiply(power[self.lower[axis, k]], h[axis] / self.exponents[k, axis], out=power[k])
        return power

    def multiply(self, p: FloatArray, q: FloatArray, degree: int) -> FloatArray:
        """p q up to a degree; shape (monomials, k)."""
        product = np.zeros((self.size(degree), q.shape[1]))
        degrees = self.exponents.sum(axis=1)
        for alpha, coefficient in enumerate(p):
            rest = min(len(q), self.size(degree - int(degrees[alpha])))
            product[self.sums[alpha, :rest]] += coefficient * q[:rest]
        return product

    def multiply_linear(self, a: FloatArray, q: FloatArray) -> FloatArray:
        """⟨a, ξ⟩ q, one degree higher than q; shape (monomials, k) from a of shape (m, k)."""
        size = self.size(int(self.exponents[len(q) - 1].sum()) + 1)
        padded = np.concatenate([q, np.zeros((size + 1 - len(q), q.shape[1]))])
        return np.asarray(np.einsum("ik,iak->ak", a, padded[self.lower[:, :size]]))

    def contract(self, t: FloatArray, p: FloatArray, degrees: range, totals: range) -> FloatArray:
        """Σ_β t_{α+β} p_β for |α| in ``degrees``, over |α + β| in ``totals``; shape (monomials, k), else 0.

        For t_α = ∂^α φ these are the derivatives of p(∇) φ.  It is the transpose of multiplication by p as well.
        """
        result = np.zeros((self.size(degrees[-1]), t.shape[1]))
        for i in degrees:
            own = self.of_degree[i]
            for total in totals:
                if total - i >= 0 and self.of_degree[total - i].stop <= len(p):
                    other = self.of_degree[total - i]
                    result[own] += np.einsum("abk,bk->ak", t[self.sums[own, other]], p[other])
        return result


@lru_cache
def polynomials(dimension: int, degree: int) -> Polynomials:
    """The polynomials of a degree, whose tables are made once."""
    return Polynomials(dimension, degree)


def kernel_derivatives(table: Polynomials, d: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """∂^α 1/|d|², to a degree, and ∂^α log|d|, α ≠ 0, to two more, each (monomials, k); d has shape (m, k)."""
    # Taylor coefficients s_α = ∂^α (1/|d|²)/α!, and a row of zeros at the end.  From s |d + w|² = 1, in every degree,
    # |d|² s_α + 2 Σ_i d_i s_{α−e_i} + Σ_i s_{α−2e_i} = 0
    s = np.zeros((table.size(degree + 1) + 1, d.shape[1]))
    s[0] = 1.0 / column_dot(d, d)
    slope = -2.0 * d * s[0]
    for monomials in table.of_degree[1 : degree + 2]:
        once = table.lower[:, monomials]
        twice = np.stack([np.where(row < 0, -1, lower[row]) for row, lower in zip(once, table.lower, strict=True)])
        s[monomials] = np.einsum("ik,iak->ak", slope, s[once]) - s[0] * s[twice].sum(axis=0)
    # those of log|d|, whose gradient is d/|d|²: γ_i log_γ = d_i s_{γ−e_i} + s_{γ−2e_i}, for any i
    size = table.size(degree + 2)
    exponents = table.exponents[1:size]
    axis = np.argmax(exponents > 0, axis=1)
    once = table.lower[axis, np.arange(1, size)]
    log = np.zeros((size, d.shape[1]))
    log[1:] = d[axis]
    log[1:] *= s[once]
    log[1:] += s[np.where(once < 0, -1, table.lower[axis, once])]
    log[1:] /= exponents[np.arange(size - 1), axis][:, None]
    numbers = np.cumprod(np.maximum(np.arange(degree + 3), 1)).astype(np.float64)
    factorial = numbers[table.exponents[:size]].prod(axis=1)[:, None]  # α!
    return s[: table.size(degree)] * factorial[: table.size(degree)], log * factorial
