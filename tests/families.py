"""Whole families of knots, of which a few are looked at every time, and all by --slow."""

from collections.abc import Iterable
from typing import Any

import pytest

EVERY = 12


def family(names: Iterable[str]) -> list[Any]:
    """Every twelfth name, and the others as parameters marked slow."""
    return [pytest.param(name, marks=pytest.mark.slow if k % EVERY else ()) for k, name in enumerate(names)]
