"""Standard streams as curves and trajectories, verdicts as JSON, and where results come from."""

import hashlib
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from curve_formats import OF_VERTICES
from families import family
from mobius_flow import __version__
from mobius_flow.cli import main
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.io.source import MAX_BYTES
from mobius_flow.core.proof import verify
from shapes import regular_polygon, torus_trefoil

NAMES = [suffix[1:] for suffix in OF_VERTICES]
PROGRAM = f"{sys.executable} -P -m mobius_flow"
SHORT = ["--vertices", "60", "--max-iterations", "2"]


@pytest.fixture
def trefoil(tmp_path: Path) -> Path:
    path = tmp_path / "trefoil.txt"
    write_curve(path, torus_trefoil(60))
    return path


@pytest.fixture
def trajectory(trefoil: Path, tmp_path: Path) -> Path:
    path = tmp_path / "t.npz"
    assert main(["relax", str(trefoil), str(tmp_path / "o.txt"), "--trajectory", str(path), "--quiet", *SHORT]) == 0
    return path


def give(data: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make some bytes the standard input."""
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data), encoding="utf-8"))


@pytest.mark.parametrize("name", NAMES)
def test_curves_go_through_standard_streams(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["knot", "3_1", "-", "--format", name]) == 0
    text = capsys.readouterr().out
    assert main(["knot", "3_1", str(tmp_path / f"k.{name}")]) == 0
    assert text == (tmp_path / f"k.{name}").read_text()
    give(text.encode(), monkeypatch)
    assert main(["energy", "-", "--format", name]) == 0
    energy = float(capsys.readouterr().out)
    give(text.encode(), monkeypatch)
    assert main(["relax", "-", "-", "--format", name, "--max-iterations", "2", "--quiet"]) == 0
    (tmp_path / f"o.{name}").write_text(capsys.readouterr().out)
    give((tmp_path / f"o.{name}").read_bytes(), monkeypatch)
    assert main(["energy", "-", "--format", name]) == 0
    assert float(capsys.readouterr().out) < energy


def test_columns_are_the_default(
    trefoil: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    give(trefoil.read_bytes(), monkeypatch)
    assert main(["relax", "-", "-", "--quiet", *SHORT]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 60


def test_a_suffix_wins_and_names_without_one_need_the_format(
    trefoil: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plain = tmp_path / "plain"
    plain.write_bytes(trefoil.read_bytes())
    assert main(["energy", str(plain)]) == 2
    assert main(["energy", str(plain), "--format", "xyz"]) == 0
    assert main(["relax", str(plain), str(tmp_path / "o.obj"), "--format", "txt", *SHORT]) == 0
    assert (tmp_path / "o.obj").read_text().startswith("v ")
    assert main(["relax", str(trefoil), str(tmp_path / "data"), "--format", "vect", *SHORT]) == 0
    assert (tmp_path / "data").read_text().startswith("VECT")


def test_errors_in_standard_input_name_it(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    give(b"0 0 0\n1 x 0\n", monkeypatch)
    assert main(["energy", "-"]) == 2
    assert capsys.readouterr().err.startswith("mobius-flow: standard input, line 2: ")
    monkeypatch.setattr(sys, "stdin", None)
    for command in ("energy", "verify"):
        assert main([command, "-"]) == 2
        assert "standard input" in capsys.readouterr().err


@pytest.mark.skipif(not os.path.exists("/dev/stdout"), reason="no such device")
@pytest.mark.parametrize("target", family(["-", "/dev/stdout"]))
def test_report_and_trajectory_go_through_a_pipe(trefoil: Path, tmp_path: Path, target: str) -> None:
    relax = f"{PROGRAM} relax {trefoil} {tmp_path / 'o.txt'} --quiet --max-iterations 2"
    report = subprocess.run(f"{relax} --report {target} | cat", shell=True, capture_output=True, check=True).stdout
    assert json.loads(report)["iterations"] == 2
    line = f"{relax} --trajectory {target} | {PROGRAM} verify - --json"
    verdict = json.loads(subprocess.run(line, shell=True, capture_output=True, check=True).stdout)
    assert (verdict["accepted"], verdict["legs"]) == (True, 2)


@pytest.mark.skipif(not os.path.exists("/dev/stdout"), reason="no such device")
def test_a_report_is_added_to_what_standard_output_is_sent_to(trefoil: Path, tmp_path: Path) -> None:
    log = tmp_path / "log"
    log.write_text("before\n")
    line = f"{PROGRAM} relax {trefoil} {tmp_path / 'o.txt'} --quiet --max-iterations 1 --report /dev/stdout >> {log}"
    subprocess.run(line, shell=True, check=True)
    first, rest = log.read_text().split("\n", 1)
    assert first == "before"
    assert json.loads(rest)["iterations"] == 1


def test_a_verdict_as_json(
    trajectory: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(trajectory), "--json"]) == 0
    accepted = json.loads(capsys.readouterr().out)
    assert (accepted["accepted"], accepted["stages"], accepted["legs"]) == (True, 1, 2)
    give(trajectory.read_bytes(), monkeypatch)
    assert main(["verify", "-", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == accepted
    start = torus_trefoil(20).vertices
    moved = start.copy()
    moved[0] = start[10] + (start[10] - start[0])
    np.savez(trajectory, stage_000=np.stack([start, moved]), component_sizes_000=np.array([20]))
    assert main(["verify", str(trajectory), "--json"]) == 1
    rejected = json.loads(capsys.readouterr().out)
    assert not rejected["accepted"]
    assert rejected["stage"] == rejected["frame"] == 0
    first, second = rejected["edges"]
    assert f"edges {first} and {second} (counted from 1) meet" in rejected["reason"]


@pytest.mark.parametrize("extra", [[], ["--json"]])
def test_trajectories_that_cannot_be_read_are_bad_input(
    extra: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in (tmp_path, tmp_path / "none.npz", "a\0b", ""):
        assert main(["verify", str(path), *extra]) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.count("\n") == 1
        assert f"{path}: cannot be read: ".replace("\0", "") in captured.err.replace("\\x00", "")
    damaged = tmp_path / "damaged.npz"
    damaged.write_bytes(b"PK\3\4 and no more")
    assert main(["verify", str(damaged), *extra]) == 1
    assert "cannot be read" in capsys.readouterr().out


def test_a_stream_that_is_no_trajectory(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    give(b"0 0 0\n" * 1000, monkeypatch)
    assert main(["verify", "-"]) == 2
    assert "standard input: not a trajectory" in capsys.readouterr().err


def test_verify_tells_how_far_it_is(trajectory: Path) -> None:
    seen: list[tuple[int, int]] = []
    assert verify(trajectory, lambda *counts: seen.append(counts)).accepted
    assert seen == [(1, 2), (2, 2)]


def test_results_tell_where_they_come_from(trefoil: Path, tmp_path: Path) -> None:
    report, trajectory = tmp_path / "r.json", tmp_path / "t.npz"
    words = ["--report", str(report), "--trajectory", str(trajectory), "--quiet", "--tolerance", "0.25", *SHORT]
    assert main(["relax", str(trefoil), str(tmp_path / "o.txt"), *words]) == 0
    values = json.loads(report.read_text())
    assert values["version"] == __version__
    assert values["options"]["tolerance"] == 0.25
    assert values["options"]["method"] == "lbfgs"
    assert values["input"] == {"name": str(trefoil), "sha256": hashlib.sha256(trefoil.read_bytes()).hexdigest()}
    assert values["blas_threads"] == 1
    assert values["numpy"] == np.__version__
    with np.load(trajectory, allow_pickle=False) as archive:
        origin = json.loads(str(archive["provenance"]))
    assert origin.items() <= values.items()
    assert set(origin) == {"version", "options", "input", "blas_threads", "python", "numpy", "scipy"}
    assert verify(trajectory).accepted


LIMITED = """
import pathlib, re, sys
from mobius_flow.cli import main
status = main(sys.argv[1:])
# not ru_maxrss, in which the process that started this one counts
print(status, re.search("VmHWM: *\t* *([0-9]+) kB", pathlib.Path("/proc/self/status").read_text())[1])
"""


def measured(words: list[str], **options: object) -> tuple[int, int, str]:
    """Exit status, megabytes and standard error of a command of its own."""
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, *words], capture_output=True, text=True, check=True, **options
    )  # type: ignore[call-overload]
    status, kilobytes = done.stdout.split()[-2:]
    return int(status), int(kilobytes) >> 10, done.stderr


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="memory is told by /proc")
@pytest.mark.parametrize("command", ["relax", "energy", "compare"])
@pytest.mark.parametrize("kind", ["vertices", "more", "dimension", "zero"])
def test_limits_are_looked_at_before_memory_is_taken(command: str, kind: str, tmp_path: Path) -> None:
    path = tmp_path / ("in.json" if kind == "dimension" else "in.txt")
    if kind == "vertices":
        write_curve(path, regular_polygon(201_000))
    elif kind == "more":
        write_curve(path, regular_polygon(400_000))
    elif kind == "dimension":
        path.write_text(json.dumps([[float(k == i) for k in range(100_000)] for i in range(3)]))
    else:
        path.symlink_to("/dev/zero")
    output = {"relax": [str(tmp_path / "o.txt")], "compare": ["-o", str(tmp_path / "c.csv")]}.get(command, [])
    status, megabytes, error = measured([command, str(path), *output])
    assert status == 2
    assert error.count("\n") == 1
    assert str(path) in error
    assert megabytes < 400


@pytest.mark.parametrize("count", ["200001", "1000000", "9" * 40])
@pytest.mark.parametrize("command", ["relax", "compare"])
def test_refinement_is_limited(
    count: str, command: str, trefoil: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = {
        "relax": ["relax", str(trefoil), str(tmp_path / "o.txt")],
        "compare": ["compare", str(trefoil), "-o", str(tmp_path / "c.csv")],
    }[command]
    assert main([*words, "--vertices", count]) == 2
    assert f"vertices is {count}" in capsys.readouterr().err


def test_written_curves_can_be_read(tmp_path: Path) -> None:
    """The longest file that a relaxation can write is below the limit of files that are read."""
    curve = regular_polygon(2000)
    path = tmp_path / "o.json"
    write_curve(path, curve.with_vertices(np.pi * 1e-100 * curve.vertices))
    assert len(read_curve(path)) == 2000
    assert path.stat().st_size * 200_000 / 2000 < MAX_BYTES
