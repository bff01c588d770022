"""Standard streams as curves and trajectories, whatever state they are in; processes whose imports fail."""

import io
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from commands import PROGRAM, SHORT
from families import crossed, family
from mobius_flow.core.proof import verify
from shapes import torus_trefoil

linux = pytest.mark.skipif(sys.platform != "linux", reason="devices and descriptors of Linux")
pytestmark = pytest.mark.usefixtures("room")


def shell(line, **environment):
    """Run a line of sh in which ``flow`` is the program."""
    script = f'flow() {{ {" ".join(PROGRAM)} "$@"; }}\n{line}'
    settings = {"encoding": "utf-8", "errors": "replace", "env": {**os.environ, **environment}, "timeout": 300}

    def prepare():
        signal.signal(signal.SIGHUP, signal.SIG_DFL)

    return subprocess.run(["sh", "-c", script], capture_output=True, check=False, preexec_fn=prepare, **settings)


@pytest.fixture
def give(monkeypatch):
    """Make some bytes the standard input."""
    return lambda data: monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data), encoding="utf-8"))


@pytest.fixture
def trajectory(run):
    assert run("relax", "trefoil.txt", "o.txt", "--trajectory", "t.npz", "--quiet", *SHORT)[0] == 0
    return Path("t.npz")


def test_a_suffix_wins_names_without_one_need_the_format_and_columns_are_the_default(run, give):
    Path("plain").write_bytes(Path("trefoil.txt").read_bytes())
    assert run("energy", "plain")[0] == 2
    assert run("energy", "plain", "--format", "xyz")[0] == 0
    assert run("relax", "plain", "o.obj", "--format", "txt", *SHORT)[0] == 0
    assert Path("o.obj").read_text().startswith("v ")
    assert run("relax", "trefoil.txt", "data", "--format", "vect", *SHORT)[0] == 0
    assert Path("data").read_text().startswith("VECT")
    give(Path("trefoil.txt").read_bytes())
    assert len(run("relax", "-", "-", "--quiet", *SHORT)[1].splitlines()) == 60


def test_errors_in_standard_input_name_it(refused, give, monkeypatch):
    give(b"0 0 0\n1 x 0\n")
    assert refused("energy", "-").startswith("mobius-flow: standard input, line 2: ")
    give(b"0 0 0\n" * 1000)
    assert "standard input: not a trajectory" in refused("verify", "-")
    monkeypatch.setattr(sys, "stdin", None)
    for command in ("energy", "verify"):
        assert "standard input" in refused(command, "-")


@linux
@pytest.mark.parametrize("target", family(["-", "/dev/stdout"]))
def test_report_and_trajectory_go_through_a_pipe(target):
    relax = f"flow relax trefoil.txt o.txt --quiet --max-iterations 2 --report r.json --trajectory {target}"
    verdict = json.loads(shell(f"{relax} | flow verify - --json").stdout)
    assert json.loads(Path("r.json").read_text())["iterations"] == 2
    assert (verdict["accepted"], verdict["legs"]) == (True, 2)


def test_a_verdict_as_json(trajectory, run, give):
    status, told, _ = run("verify", trajectory, "--json")
    accepted = json.loads(told)
    assert (status, accepted["accepted"], accepted["stages"], accepted["legs"]) == (0, True, 1, 2)
    give(trajectory.read_bytes())
    assert json.loads(run("verify", "-", "--json")[1]) == accepted
    start = torus_trefoil(20).vertices
    moved = start.copy()
    moved[0] = start[10] + (start[10] - start[0])
    np.savez(trajectory, stage_000=np.stack([start, moved]), component_sizes_000=np.array([20]))
    status, told, _ = run("verify", trajectory, "--json")
    rejected = json.loads(told)
    assert (status, rejected["accepted"], rejected["stage"], rejected["frame"]) == (1, False, 0, 0)
    first, second = rejected["edges"]
    assert f"edges {first} and {second} (counted from 1) meet" in rejected["reason"]


@pytest.mark.parametrize("extra", [[], ["--json"]])
def test_trajectories_that_cannot_be_read_are_bad_input(extra, room, refused, run):
    for path in (room, "none.npz", "a\0b", ""):
        assert f"{path}: cannot be read: ".replace("\0", "\\x00") in refused("verify", path, *extra)
    Path("damaged.npz").write_bytes(b"PK\3\4 and no more")
    status, out, _ = run("verify", "damaged.npz", *extra)
    assert status == 1
    assert "cannot be read" in out


def test_verify_tells_how_far_it_is(trajectory):
    seen = []
    assert verify(trajectory, lambda *counts: seen.append(counts)).accepted
    assert seen == [(1, 2), (2, 2)]


IMPORTS = {
    "raise MemoryError": (1, "not enough memory"),
    "raise ModuleNotFoundError('No module named numpy')": (1, "No module named numpy"),
    "raise OSError(24, 'Too many open files')": (2, "Too many open files"),
    "import os, signal\nos.kill(os.getpid(), signal.SIGTERM)\nwhile True: pass": (130, "interrupted"),
    "import os, signal\nos.kill(os.getpid(), signal.SIGHUP)\nwhile True: pass": (130, "interrupted"),
    "raise KeyboardInterrupt": (130, "interrupted"),
    "nonsense here": (1, "cannot be loaded"),
}


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("code", IMPORTS)
def test_imports_that_fail(code, room):
    Path("numpy.py").write_text(code + "\n")
    done = shell("flow methods", PYTHONPATH=str(room))
    status, words = IMPORTS[code]
    assert (done.returncode, done.stderr.count("\n")) == (status, 1), done.stderr
    assert words in done.stderr


def test_help_and_version_need_no_numpy(room):
    Path("numpy.py").write_text("raise SystemError\n")
    for words in ("--version", "--help"):
        done = shell(f"flow {words}", PYTHONPATH=str(room))
        assert (done.returncode, done.stderr) == (0, "")


@linux
@pytest.mark.parametrize(("encoding", "words"), crossed(["ascii", "cp1252"], ["relax --help", "relax nö.txt o.txt"]))
def test_terminals_of_few_letters(encoding, words):
    done = shell(f"flow {words}", PYTHONIOENCODING=encoding, PYTHONUTF8="0")
    assert done.returncode == (2 if "nö" in words else 0)
    assert "Traceback" not in done.stderr
    assert done.stderr.count("\n") == ("nö" in words)


@linux
@pytest.mark.parametrize(
    ("words", "end"), crossed(["--help", "energy trefoil.txt", "knot 3_1 -"], [">/dev/full", ">&-"])
)
def test_standard_output_that_takes_nothing(words, end):
    done = shell(f"flow {words} {end}")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "standard output" in done.stderr


@linux
@pytest.mark.parametrize("end", family(["<&- 2>&-", "2>/dev/full", ">&- 2>&-", "2>&-"]))
def test_work_is_done_without_standard_error(end):
    done = shell(f"flow relax trefoil.txt o.txt --report r.json --max-iterations 2 {end}")
    assert done.returncode == 0
    assert Path("o.txt").read_text().count("\n") >= 60
    assert Path("r.json").read_text().endswith("}\n")  # no stray line went into a file of ours


@linux
@pytest.mark.parametrize("outputs", family(["-", "o.txt --report -", "o.txt --trajectory /dev/stdout"]))
def test_results_do_not_go_to_a_closed_stream(outputs):
    done = shell(f"flow relax trefoil.txt {outputs} >&-")
    assert (done.returncode, done.stderr) == (2, "mobius-flow: standard output is closed; name a file\n")


@linux
def test_a_reader_who_leaves():
    assert shell("flow knot 3_1 - --vertices 20000 | head -c 1").stderr == ""
