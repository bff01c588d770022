"""Runs whose moves have other settings."""

from functools import partial

import pytest
from mobius_flow.core.driver import moves
from mobius_flow.core.driver.move import Move


def change(monkeypatch: pytest.MonkeyPatch, kind: type[Move], **settings: object) -> None:
    """Let every run make a move with some of its fields set."""
    changed = [partial(each, **settings) if getattr(each, "func", each) is kind else each for each in moves.MOVES]
    monkeypatch.setattr(moves, "MOVES", changed)
