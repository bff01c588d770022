"""Some of the command lines of tools/odd_commands.py, two of each kind."""

import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits, signals and devices of Linux")
TOOLS = Path(__file__).resolve().parents[2] / "tools"
PATIENT = 200.0  # seconds, on a machine that has other work to do
COUNT = 34


@pytest.mark.parametrize("number", range(COUNT))
def test_odd_commands_are_taken_well(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TOOLS))
    from odd_commands import KINDS, judged

    assert 2 * len(KINDS) == COUNT
    _, case, outcome, wrong = judged(number, seed=7, patience=PATIENT)
    assert not wrong, (case, outcome)
