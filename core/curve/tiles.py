"""Blocks of edge pairs: one pass over all unordered pairs in pieces that fit the processor's cache."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..types import BoolArray
from .mesh import Mesh

ROWS_TIMES_COLUMNS = 24_000  # doubles in one tile array; some ten of them should fit a second-level cache


class Tile(NamedTuple):
    """A block of edge pairs (I, J), I in ``rows`` and J in ``columns``.

    ``excluded`` marks the pairs, as (row, column) positions in the block, that do not count: edges with a
    common vertex, and pairs that another tile (or the transposed place in this one) has already.
    """

    rows: slice
    columns: slice
    excluded: BoolArray


def pair_tiles(mesh: Mesh) -> Iterator[Tile]:
    """Cover every unordered pair of edges with disjoint closures exactly once."""
    n = mesh.size
    first = 0
    while first < n:
        last = min(n, first + max(1, ROWS_TIMES_COLUMNS // (n - first)))
        yield Tile(slice(first, last), slice(first, n), _excluded(mesh, first, last))
        first = last


def _excluded(mesh: Mesh, first: int, last: int) -> BoolArray:
    rows = np.arange(first, last)
    columns = np.arange(first, mesh.size)
    excluded: BoolArray = columns[None, :] <= rows[:, None]
    for neighbour in (mesh.heads[rows], mesh.previous[rows]):
        inside = neighbour >= first
        excluded[rows[inside] - first, neighbour[inside] - first] = True
    return excluded
