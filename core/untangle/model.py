"""The quadratic function to whose minimum an elastic rope goes in a step."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ..base import FloatArray, IntArray
from ..solve.saddle.tangent_space import factorised


class ElasticModel:
    """Forces on n vertices, less their springs, drags and stiffnesses: a quadratic function of displacements."""

    def __init__(self, n: int) -> None:
        self.force: FloatArray = np.zeros((n, 3))  # the derivative
        self.form: FloatArray = np.zeros((n, 3, 3))  # the second one, or what is as good: blocks on the diagonal
        self._blocks: list[tuple[IntArray, IntArray, FloatArray]] = []  # and elsewhere

    def couple(self, corners: Sequence[tuple[IntArray, FloatArray]], first: FloatArray, second: FloatArray) -> None:
        """Add a function of Σ c x over some vertices x, each a pair of indices and factors c, by its derivatives."""
        for a, by_a in corners:
            add_at(self.force, a, by_a[:, None] * first)
            self._blocks += [(a, b, (by_a * by_b)[:, None, None] * second) for b, by_b in corners]

    def minimum(self) -> FloatArray:
        """The displacements of least energy, shape (n, 3)."""
        n, own = len(self.form), np.arange(len(self.form))
        a, b, blocks = map(np.concatenate, zip(*self._blocks, (own, own, self.form), strict=True))
        order = np.argsort(key := a * n + b, kind="stable")
        first = np.flatnonzero(np.diff(key[order], prepend=-1))
        rows, columns = np.divmod(key[order[first]], n)
        total = sp.csr_array((np.ones(len(order)), order, np.append(first, len(order))))  # of those with one place
        blocks = (total @ blocks.reshape(-1, 9)).reshape(-1, 3, 3)
        form = sp.bsr_array((blocks, columns, np.searchsorted(rows, np.arange(n + 1))), shape=(3 * n, 3 * n)).tocsr()
        # as it is symmetric, its rows are its columns
        form = sp.csc_array((form.data, form.indices, form.indptr), shape=form.shape)
        return -np.asarray(factorised(form, symmetric=True).solve(self.force.ravel())).reshape(-1, 3)


def add_at(total: FloatArray, index: IntArray, values: FloatArray) -> None:
    """Add values, shape (k, …), to the entries at an index, which may be there several times."""
    width = total[0].size
    places = (index[:, None] * width + np.arange(width)).ravel()
    total += np.bincount(places, values.ravel(), total.size).reshape(total.shape)
