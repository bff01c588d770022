"""One handler for the command line, imports included: one sentence and the contract's exit status, whatever happens."""

import os
import signal
import subprocess
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest
from families import crossed, family
from mobius_flow import __version__
from mobius_flow.cli import main
from mobius_flow.core import write_curve
from shapes import torus_trefoil

linux = pytest.mark.skipif(sys.platform != "linux", reason="devices and descriptors of Linux")
PROGRAM = [sys.executable, "-P", "-m", "mobius_flow"]


@pytest.fixture
def trefoil(tmp_path: Path) -> str:
    path = tmp_path / "trefoil.txt"
    write_curve(path, torus_trefoil(60))
    return str(path)


def launch(words: list[str], **options: object) -> "subprocess.CompletedProcess[str]":
    env = {**os.environ, **options.pop("env", {})}  # type: ignore[dict-item]
    settings = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    return subprocess.run([*PROGRAM, *words], text=True, check=False, env=env, timeout=300, **settings)  # type: ignore[call-overload,no-any-return]


def shell(line: str, trefoil: str, env: Mapping[str, str] | None = None) -> "subprocess.CompletedProcess[str]":
    """Run a line of sh in which ``flow`` is the program and ``$1`` the curve."""
    script = f'flow() {{ {" ".join(PROGRAM)} "$@"; }}\n{line}'
    command = ["sh", "-c", script, "sh", trefoil]
    return subprocess.run(
        command,
        capture_output=True,
        encoding="utf-8",
        errors="replace",
        check=False,
        env={**os.environ, **(env or {})},
        timeout=300,
    )


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
def test_imports_that_fail(code: str, tmp_path: Path) -> None:
    (tmp_path / "numpy.py").write_text(code + "\n")
    done = launch(["methods"], env={"PYTHONPATH": str(tmp_path)}, preexec_fn=_default_hangup)
    status, words = IMPORTS[code]
    assert done.returncode == status, done.stderr
    assert done.stderr.count("\n") == 1
    assert words in done.stderr


def _default_hangup() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def test_help_and_version_need_no_numpy(tmp_path: Path) -> None:
    (tmp_path / "numpy.py").write_text("raise SystemError\n")
    for words in (["--version"], ["--help"]):
        done = launch(words, env={"PYTHONPATH": str(tmp_path)})
        assert (done.returncode, done.stderr) == (0, "")


@linux
@pytest.mark.parametrize(("encoding", "words"), crossed(["ascii", "cp1252"], ["relax --help", "relax nö.txt o.txt"]))
def test_terminals_of_few_letters(trefoil: str, encoding: str, words: str) -> None:
    done = shell(f"flow {words}", trefoil, {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"})
    assert done.returncode == (2 if "nö" in words else 0)
    assert "Traceback" not in done.stderr
    assert done.stderr.count("\n") == ("nö" in words)


@linux
@pytest.mark.parametrize(
    ("words", "end"), crossed(["methods", "--help", 'energy "$1"', "knot 3_1 -"], [">/dev/full", ">&-"])
)
def test_standard_output_that_takes_nothing(trefoil: str, words: str, end: str) -> None:
    done = shell(f"flow {words} {end}", trefoil)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "standard output" in done.stderr


@linux
@pytest.mark.parametrize("end", family(["2>/dev/full", "<&- 2>&-", ">&- 2>&-", "2>&-"], every=2))
def test_work_is_done_without_standard_error(trefoil: str, tmp_path: Path, end: str) -> None:
    out, report = tmp_path / "o.txt", tmp_path / "r.json"
    done = shell(f'flow relax "$1" {out} --report {report} --max-iterations 2 {end}', trefoil)
    assert done.returncode == 0
    assert out.read_text().count("\n") >= 60
    assert report.read_text().endswith("}\n")  # no stray line went into a file of ours


@linux
@pytest.mark.parametrize("outputs", family(["-", "o.txt --report -", "o.txt --trajectory /dev/stdout"]))
def test_results_do_not_go_to_a_closed_stream(trefoil: str, tmp_path: Path, outputs: str) -> None:
    done = shell(f'cd {tmp_path} && flow relax "$1" {outputs} >&-', trefoil)
    assert (done.returncode, done.stderr) == (2, "mobius-flow: standard output is closed; name a file\n")


@linux
def test_a_reader_who_leaves(trefoil: str) -> None:
    done = shell("flow knot 3_1 - --vertices 20000 | head -c 1", trefoil)
    assert done.stderr == ""


@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (MemoryError(), 1, "not enough memory"),
        (OSError(28, "No space left on device", "x.txt"), 2, "x.txt: No space left on device"),
        (ZeroDivisionError("oh"), 1, "ZeroDivisionError: oh"),
        (KeyboardInterrupt(), 130, "interrupted"),
    ],
)
def test_whatever_a_command_raises(
    trefoil: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: BaseException,
    status: int,
    words: str,
) -> None:
    def failing(*_: object) -> None:
        raise error

    monkeypatch.setattr("mobius_flow.cli.info.measure", failing)
    assert main(["energy", trefoil]) == status
    said = capsys.readouterr().err
    assert words in said
    assert said.count("\n") == 1


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"mobius-flow {__version__}\n"
    project = tomllib.loads((Path(__file__).resolve().parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
    assert __version__ == project["project"]["version"]


def test_the_bare_command_prints_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    printed = capsys.readouterr()
    assert "exit status" in printed.out
    assert printed.err == "mobius-flow: name a command\n"


@pytest.mark.parametrize("command", ["relax", "energy", "verify", "compare", "knot", "methods"])
def test_help_has_exit_statuses_and_no_markup(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    text = capsys.readouterr().out
    assert "exit status" in text
    assert command == "methods" or "example" in text
    assert "``" not in text


@pytest.mark.parametrize(
    ("words", "guess"),
    [
        (["relx"], "relax"),
        (["relax", "IN", "OUT", "--vertice", "5"], "--vertices"),
        (["relax", "IN", "o.txt", "--max", "5"], "--max-iterations"),
        (["relax", "IN", "o.txt", "--method", "trust"], "trust-region"),
        (["--verison"], "--version"),
        (["relax", "IN", "o.txt", "--method", "lbgfs"], "lbfgs"),
        (["relax", "IN", "o.txt", "--energy", "moebus"], "moebius"),
        (["relax", "IN", "o.txt", "--metric", "moebus"], "moebius"),
        (["relax", "IN", "o.obk"], ".obj"),
        (["energy", "a.jsn"], ".json"),
        (["energy", "IN", "--energy", "vertx"], "vertex"),
        (["energy", "IN", "--format", "jsn"], "json"),
        (["compare", "IN", "-o", "a.cvs"], ".csv"),
        (["knot", "figure-eigth", "k.txt"], "figure eight"),
    ],
)
def test_suggestions(words: list[str], guess: str, trefoil: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([trefoil if word == "IN" else word for word in words]) == 2
    said = capsys.readouterr().err
    assert f"did you mean {guess}" in said
    assert said.count("\n") == 1


@pytest.mark.parametrize("words", [["--vers"], ["relax", "IN", "o.txt", "--max", "3"], ["energy", "IN", "--js"]])
def test_options_have_no_abbreviations(words: list[str], trefoil: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([trefoil if word == "IN" else word for word in words]) == 2
    assert capsys.readouterr().err.count("\n") == 1


REFUSED_AFTER_A_NOTE = {
    "faces.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2 1\n",
    "alone.obj": "v 0 0 0\nv 1 0 0\nv 1 0 0\n",
    "closing.txt": "0 0 0\n1 0 0\n1 0 0\n0 1 0\n0 0 0\n",
}


@pytest.mark.parametrize("name", REFUSED_AFTER_A_NOTE)
@pytest.mark.parametrize("command", ["relax", "energy"])
def test_a_refusal_is_one_line_whatever_was_noted_before(
    name: str, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    path.write_text(REFUSED_AFTER_A_NOTE[name])
    assert main([command, str(path), *([str(tmp_path / "o.txt")] if command == "relax" else [])]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"{path}, line " in said


def test_notes_are_printed_unless_quiet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "closing.txt"
    path.write_text("0 0 0\n1 0 0\n1 1 0\n0 1 1\n0 0 0\n")
    words = ["relax", str(path), str(tmp_path / "o.txt"), "--max-iterations", "1"]
    assert main([*words, "--quiet"]) == 0
    assert capsys.readouterr().err == ""
    assert main(words) == 0
    assert "repeats its first; dropped" in capsys.readouterr().err.splitlines()[0]
    assert main(["energy", str(path)]) == 0
    assert "repeats its first; dropped" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [
        ("same.txt", "0 0 0\n1 0 0\n# more\n1 1 0\n1 1 0\n0 1 0\n", 4),
        ("back.obj", "v 0 0 0\nv 2 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3 4 1\n", 2),
        ("touch.vect", "VECT\n1 5 0\n-5\n0\n0 0 0\n2 0 0\n2 1 0\n1 0 0\n1 -1 0\n", 5),
        ("far.json", "[[0,0,0],\n[1e50,0,0],\n[0,1,0]]", 2),
    ],
)
@pytest.mark.parametrize("command", ["relax", "energy", "compare"])
def test_geometric_refusals_name_file_and_line(
    name: str, text: str, line: int, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    path.write_text(text)
    output = {"relax": [str(tmp_path / "o.txt")], "compare": ["-o", str(tmp_path / "o.csv")]}.get(command, [])
    assert main([command, str(path), *output]) == 2
    assert capsys.readouterr().err.startswith(f"mobius-flow: {path}, line {line}: ")
