"""Some of the command lines of tools/odd_commands.py, of each kind."""

import runpy
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits, signals and devices of Linux")
TOOLS = Path(__file__).resolve().parents[2] / "tools"
KINDS = runpy.run_path(str(TOOLS / "odd_commands.py"))["KINDS"] if sys.platform == "linux" else ()
PATIENT = ["--patience", "200"]  # on a machine that has other work to do


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_odd_commands_are_taken_well(kind):
    # a process of its own: the memory of the one that starts a command counts as the command's
    words = [sys.executable, str(TOOLS / "odd_commands.py"), "--only", kind, "--count", "2", "--seed", "7", *PATIENT]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("2 commands, 0 taken badly")
