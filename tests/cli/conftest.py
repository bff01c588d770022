"""What the tests of the command line have in common."""

import tempfile

import pytest
from mobius_flow.cli.main import main


@pytest.fixture(autouse=True)
def scratch(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results that are rescued, also by processes of their own, go where pytest clears them away."""
    place = str(tmp_path_factory.mktemp("scratch"))
    monkeypatch.setattr(tempfile, "tempdir", place)
    monkeypatch.setenv("TMPDIR", place)


@pytest.fixture
def run(capsys):
    """Run a command; its exit status and both outputs."""

    def runner(*arguments):
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner
