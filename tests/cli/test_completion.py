"""What shells complete."""

import shutil
import subprocess
import sys

import pytest
from mobius_flow.cli import main

COMPLETE = """
source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
eval "$(complete -p mobius-flow | sed 's/.*-F \\(\\S*\\).*/\\1/')"
echo "${COMPREPLY[@]}"
"""


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash")
@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["re"], "relax"),
        (["relax", "--untangle", "n"], "never"),
        (["relax", "--esc"], "--escape-saddles"),
        (["batch", "--method", "penalty-n"], "penalty-nesterov"),
        (["verify", "pat"], "path.npz"),
    ],
)
def test_bash_completes_commands_options_names_and_files(words, offered, tmp_path, monkeypatch, capsys):
    pytest.importorskip("shtab")
    assert main(["--print-completion", "bash"]) == 0
    (tmp_path / "script").write_text(capsys.readouterr().out)
    (tmp_path / "path.npz").touch()
    command = ["bash", "-c", COMPLETE, "bash", "./script", "mobius-flow", *words]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert offered in done.stdout.split()


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_have_scripts(shell, capsys):
    pytest.importorskip("shtab")
    assert main(["--print-completion", shell]) == 0
    assert "escape-saddles" in capsys.readouterr().out


def test_completion_names_what_is_missing(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["--print-completion", "bash"]) == 2
    assert "pip install shtab" in capsys.readouterr().err
    assert main(["--print-completion", "tcsh"]) == 2
    assert "'tcsh' is unknown; choose one of bash, zsh, fish" in capsys.readouterr().err
