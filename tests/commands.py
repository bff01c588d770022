"""What the tests of the command line have in common."""

import os
import signal
import sys
import tempfile
from contextlib import nullcontext

import pytest
from mobius_flow.cli.main import main
from mobius_flow.core import write_curve
from shapes import torus_trefoil

PROGRAM = [sys.executable, "-P", "-m", "mobius_flow"]
SHORT = ["--vertices", "60", "--max-iterations", "2"]


@pytest.fixture(autouse=True)
def scratch(tmp_path_factory, monkeypatch):
    """Results that are rescued, also by processes of their own, go where pytest clears them away."""
    place = tmp_path_factory.mktemp("scratch")
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    monkeypatch.setenv("TMPDIR", str(place))
    return place


@pytest.fixture
def room(tmp_path, monkeypatch):
    """The working directory, with a curve."""
    monkeypatch.chdir(tmp_path)
    write_curve("trefoil.txt", torus_trefoil(60))
    return tmp_path


@pytest.fixture
def on_iterate(monkeypatch):
    """Let a function see the iterates of runs, as what shows their progress does."""
    return lambda seen: monkeypatch.setattr("mobius_flow.cli.relax.progress", lambda *_: nullcontext(seen))


@pytest.fixture
def run(capsys):
    """Run a command; its exit status and both outputs."""

    def runner(*arguments):
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return runner


@pytest.fixture
def refused(run):
    """Run a command that is bad input; the one line that it says."""

    def runner(*arguments):
        status, out, err = run(*arguments)
        assert (status, out, err.count("\n")) == (2, "", 1), err
        return err

    return runner


@pytest.fixture
def terminated():
    """SIGTERM and SIGHUP as in a terminal, whatever pytest was started from, and a function that sends one."""
    numbers = (signal.SIGTERM, signal.SIGHUP)
    before = {number: signal.signal(number, signal.SIG_DFL) for number in numbers}
    yield lambda number=signal.SIGTERM: os.kill(os.getpid(), number)
    for number, handler in before.items():
        signal.signal(number, handler)
