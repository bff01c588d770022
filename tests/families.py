"""Whole families, of which a few members are looked at every time, and all by --slow."""

from collections.abc import Iterable
from itertools import product
from typing import Any

import pytest

EVERY = 12


def family(members: Iterable[Any], every: int = EVERY) -> list[Any]:
    """Every twelfth member, and the others as parameters marked slow."""
    return [pytest.param(each, marks=pytest.mark.slow if k % every else ()) for k, each in enumerate(members)]


def crossed(*lists: Iterable[Any]) -> list[Any]:
    """All combinations; every value is in one that is looked at every time, the others are marked slow."""
    values = [list(each) for each in lists]
    sizes = [len(each) for each in values]
    quick = {tuple(k % size for size in sizes) for k in range(max(sizes))}
    return [
        pytest.param(*combination, marks=() if place in quick else pytest.mark.slow)
        for place, combination in zip(product(*map(range, sizes)), product(*values), strict=True)
    ]
