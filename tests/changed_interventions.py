"""Runs whose interventions have other settings."""

from functools import partial

import pytest
from mobius_flow.core.driver import loop
from mobius_flow.core.driver.run import Intervention


def change(monkeypatch: pytest.MonkeyPatch, kind: type[Intervention], **settings: object) -> None:
    """Let every run make an intervention with some of its fields set."""
    changed = [
        partial(each, **settings) if getattr(each, "func", each) is kind else each for each in loop.INTERVENTIONS
    ]
    monkeypatch.setattr(loop, "INTERVENTIONS", changed)
