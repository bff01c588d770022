"""Options of the command line, and their completion."""

import argparse
import json
import re
import shutil
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest
from mobius_flow.cli import main
from mobius_flow.cli import options as relax_options
from mobius_flow.core import RelaxOptions, read_curve
from mobius_flow.core.base.arguments import declared
from option_values import unlike_default


def parsed(*words, **keywords):
    parser = argparse.ArgumentParser()
    relax_options.add_to(parser, **keywords)
    return relax_options.from_arguments(parser.parse_args(words))


def test_every_option_stands_in_the_help(capsys):
    assert main(["relax", "--help-all"]) == 0
    shown = capsys.readouterr().out
    words = " ".join(shown.split()).replace("- ", "-")
    for each in declared(RelaxOptions):
        assert f"\n  {relax_options.flag(each)} " in shown
        assert each.help.replace("- ", "-") in words
        if each.kind is not bool and not each.repeated:
            assert f"(default: {each.automatic or each.default})" in words
        for name in each.choices or ():
            assert name in words


@pytest.mark.parametrize("command", ["relax", "morph", "same", "batch", "compare"])
def test_the_short_help_has_what_most_need(command, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    assert main([command, "--help"]) == 0
    short = capsys.readouterr().out
    assert main([command, "--help-all"]) == 0
    whole = capsys.readouterr().out
    for line in short.splitlines():
        assert line in whole
    found = re.findall(r"^  (--\S+)", short, re.MULTILINE)
    assert set(found) >= {"--vertices", "--tolerance", "--max-iterations", "--time-limit", "--help-all"}
    assert len(found) <= 16
    assert len(set(re.findall(r"^  (--\S+)", whole, re.MULTILINE)) - set(found)) >= 10
    assert "[options]" in short.splitlines()[0]


def test_every_option_has_a_place_in_the_help():
    """One that has none is shown with further options, as those of plug-ins are."""
    placed = [name for names in relax_options.GROUPS.values() for name in names]
    assert sorted(placed) == sorted(option.name for option in declared(RelaxOptions))


def test_defaults_are_the_librarys():
    assert parsed() == RelaxOptions() == parsed(without=("method",))


@pytest.mark.parametrize(
    "each", [each for each in declared(RelaxOptions) if each.name != "avoid"], ids=lambda e: e.name
)
def test_every_option_can_be_given(each):
    value = unlike_default(each)
    text = "=".join(map(str, value[0])) if each.repeated else str(value)
    words = [relax_options.flag(each), *([] if value is True else [text])]
    assert asdict(parsed(*words)) == asdict(RelaxOptions()) | {each.name: value}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--vertices", "2"], "vertices is 2; it must be 3 or more"),
        (["--vertices", "1e3"], "argument --vertices: '1e3' is not a whole number"),
        (["--tolerance", "small"], "argument --tolerance: 'small' is not a number"),
        (["--quadrature-points", "17"], "quadrature_points is 17; it must be from 1 to 16"),
        (["--penalty", "0"], "penalty is 0.0; it must be a finite number above 0"),
        (["--metric", "l7"], "metric 'l7' is unknown"),
    ],
)
def test_bounds_hold_before_a_file_is_read(words, said, tmp_path, capsys):
    assert main(["relax", str(tmp_path / "missing.txt"), str(tmp_path / "o.txt"), *words]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("word", ["--mesh=finer", "--mesh=fixed", "--mesh=adaptive", "--untangle=always"])
@pytest.mark.usefixtures("room")
def test_keyframes_follow_all_changes_of_mesh(word, run):
    pytest.importorskip("bpy")
    assert run("relax", "trefoil.txt", "o.blend", "--quiet", word, "--max-iterations=1")[0] == 0


def test_options_of_the_subcommand_itself_are_not_the_relaxations():
    parser = argparse.ArgumentParser()
    parser.add_argument("--time-limit", type=float)
    relax_options.add_to(parser, without=("time_limit",))
    assert relax_options.from_arguments(parser.parse_args(["--time-limit", "5"])).time_limit is None


@pytest.mark.usefixtures("room")
def test_a_time_limit_ends_like_an_interrupt(run):
    words = "relax trefoil.txt o.txt --report r.json --trajectory t.npz --time-limit 1e-6 --vertices 60"
    assert run(*words.split())[0] == 0
    found = json.loads(Path("r.json").read_text())
    assert (found["status"], found["options"]["time_limit"]) == ("time_limit", 1e-6)
    assert len(read_curve("o.txt")) == 60
    assert run("verify", "t.npz")[0] == 0


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
