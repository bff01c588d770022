"""What the tests of the command line have in common."""

import tempfile
from collections.abc import Callable
from contextlib import nullcontext

import pytest
from mobius_flow.cli.main import main
from mobius_flow.core import Iterate


@pytest.fixture(autouse=True)
def scratch(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results that are rescued, also by processes of their own, go where pytest clears them away."""
    place = str(tmp_path_factory.mktemp("scratch"))
    monkeypatch.setattr(tempfile, "tempdir", place)
    monkeypatch.setenv("TMPDIR", place)


@pytest.fixture
def on_iterate(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Iterate], object]], None]:
    """Let a function see the iterates of runs, as what shows their progress does."""
    return lambda seen: monkeypatch.setattr("mobius_flow.cli.relax.progress", lambda *_: nullcontext(seen))


@pytest.fixture
def run(capsys):
    """Run a command; its exit status and both outputs."""

    def runner(*arguments):
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner
