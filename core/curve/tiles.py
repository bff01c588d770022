"""Blocks of edge pairs: one pass over all unordered pairs in pieces that fit the processor's cache."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..types import BoolArray, IntArray
from .mesh import Mesh

ROWS_TIMES_COLUMNS = 24_000  # doubles in one tile array; some ten of them should fit a second-level cache


class Tile(NamedTuple):
    """A block of edge pairs (I, J), I in ``rows`` and J in ``columns``."""

    rows: slice
    columns: slice
    excluded: BoolArray  # pairs that do not count: edges with a common vertex, and what is in another tile or place


class RowTile(NamedTuple):
    """The same for rows that do not follow each other, and all columns."""

    rows: IntArray
    columns: slice
    excluded: BoolArray


EdgePairIndices = tuple[IntArray, IntArray]
"""Unordered pairs of edges (i, j), each of shape (pairs,)."""


def pair_tiles(mesh: Mesh, without: EdgePairIndices | None = None, size: int = ROWS_TIMES_COLUMNS) -> Iterator[Tile]:
    """Cover every unordered pair of edges with disjoint closures exactly once, but for some that are left out."""
    n = mesh.edges
    touching = np.stack([np.arange(n), mesh.next])
    left_out = np.sort(touching if without is None else np.hstack([touching, np.stack(without)]), axis=0)
    left_out = left_out[:, np.argsort(left_out[0])]
    begins = np.searchsorted(left_out[0], np.arange(n + 1))
    first = 0
    while first < n:
        last = min(n, first + max(1, size // (n - first)))
        excluded = np.zeros((last - first, n - first), dtype=np.bool_)
        excluded[:, : last - first] = np.tri(last - first, dtype=np.bool_)
        row, column = left_out[:, begins[first] : begins[last]] - first
        excluded[row, column] = True
        yield Tile(slice(first, last), slice(first, n), excluded)
        first = last


def row_tiles(mesh: Mesh, rows: IntArray, without: EdgePairIndices | None = None) -> Iterator[RowTile]:
    """Cover the pairs of some edges with all others, each edge's in one row, but for pairs that are left out."""
    height = max(1, ROWS_TIMES_COLUMNS // mesh.edges)
    for first in range(0, len(rows), height):
        own = rows[first : first + height]
        excluded = np.zeros((len(own), mesh.edges), dtype=np.bool_)
        for neighbour in (own, mesh.next[own], mesh.previous[own]):
            excluded[np.arange(len(own)), neighbour] = True
        for i, j in () if without is None else (without, without[::-1]):
            row, pair = np.nonzero(own[:, None] == i)
            excluded[row, j[pair]] = True
        yield RowTile(own, slice(None), excluded)
