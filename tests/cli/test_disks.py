"""Disks that are full or read-only, and places where no file can be: one sentence, and the old file stays."""

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from mobius_flow.cli import main
from mobius_flow.cli.places import OUTPUTS
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.io import FORMATS, written_formats
from processes import finished
from shapes import torus_trefoil

SHORT = ["--vertices", "60", "--max-iterations", "2", "--quiet"]


@pytest.fixture
def trefoil(tmp_path: Path) -> str:
    path = tmp_path / "trefoil.txt"
    write_curve(path, torus_trefoil(60))
    return str(path)


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 8 kB, where the test may mount one."""
    if sys.platform != "linux" or os.geteuid() != 0:
        pytest.skip("only the superuser mounts disks")
    place = tmp_path / "disk"
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(place)]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("no disk can be mounted here")
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)


def fill(disk: Path) -> None:
    with contextlib.suppress(OSError), (disk / "full").open("wb", buffering=0) as stream:
        while stream.write(b"x" * 512):
            pass


def error_of(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """The one line of a command that fails."""
    capsys.readouterr()
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err


def outputs_in(place: Path) -> dict[str, list[str]]:
    """Arguments that write one output each into a directory, by the file's name."""
    named = {f"o{suffix}": [str(place / f"o{suffix}")] for suffix in written_formats()}
    elsewhere = str(place.parent / "elsewhere.txt")
    extras = {name: [elsewhere, option, str(place / name)] for name, option in EXTRAS.items()}
    return named | extras


EXTRAS = {"r.json": "--report", "t.npz": "--trajectory"}
NAMES = [*(f"o{suffix}" for suffix in written_formats()), *EXTRAS]


@pytest.mark.parametrize("name", NAMES)
def test_a_full_disk_keeps_the_old_file(
    disk: Path, trefoil: str, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    (disk / name).write_text("old")
    fill(disk)
    error = error_of(["relax", trefoil, *outputs_in(disk)[name], *SHORT], capsys)
    assert f"{disk / name}: cannot be written: No space left on device" in error
    assert (disk / name).read_text() == "old"
    assert sorted(os.listdir(disk)) == sorted(["full", name])


@pytest.mark.parametrize("name", NAMES)
def test_a_read_only_disk_is_refused_before_the_work(
    disk: Path, trefoil: str, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    (disk / name).write_text("old")
    subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
    error = error_of(["relax", trefoil, *outputs_in(disk)[name], *SHORT], capsys)
    assert "is write-protected" in error
    assert (disk / name).read_text() == "old"


def test_a_report_without_room_costs_nothing_else(
    disk: Path, trefoil: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fill(disk)
    out, trajectory = tmp_path / "o.txt", tmp_path / "t.npz"
    extras = ["--report", str(disk / "r.json"), "--trajectory", str(trajectory)]
    assert "r.json: cannot be written" in error_of(["relax", trefoil, str(out), *extras, *SHORT], capsys)
    assert len(read_curve(out)) == 60
    assert main(["verify", str(trajectory)]) == 0


LIMITED = """
import resource, sys
from mobius_flow.cli import main
resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.skipif(os.name != "posix", reason="limits of file sizes")
def test_files_that_may_not_grow(trefoil: str, tmp_path: Path) -> None:
    """Every output fails, and all are told in one sentence."""
    names = ["o.obj", *EXTRAS]
    for name in names:
        (tmp_path / name).write_text("old")
    extras = [word for name, option in EXTRAS.items() for word in (option, str(tmp_path / name))]
    command = [sys.executable, "-c", LIMITED, "relax", trefoil, str(tmp_path / "o.obj"), *extras, *SHORT]
    done = finished(command)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    for name in names:
        assert f"{name}: cannot be written: File too large" in done.stderr
        assert (tmp_path / name).read_text() == "old"
    assert sorted(os.listdir(tmp_path)) == sorted([*names, "trefoil.txt"])


@pytest.mark.parametrize("name", NAMES)
def test_directories_and_missing_places(
    trefoil: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    missing = tmp_path / "no" / "such"
    assert "does not exist" in error_of(["relax", trefoil, *outputs_in(missing)[name][-3:], *SHORT], capsys)
    (tmp_path / "place" / name).mkdir(parents=True)
    error = error_of(["relax", trefoil, *outputs_in(tmp_path / "place")[name], *SHORT], capsys)
    assert "is a directory; name a file" in error


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the superuser may write anywhere")
def test_a_write_protected_file_and_directory(trefoil: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place = tmp_path / "place"
    place.mkdir()
    (place / "o.txt").write_text("old")
    (place / "o.txt").chmod(0o444)
    assert "write-protected" in error_of(["relax", trefoil, str(place / "o.txt"), *SHORT], capsys)
    place.chmod(0o555)
    assert "write-protected" in error_of(["relax", trefoil, str(place / "p.txt"), *SHORT], capsys)


@pytest.mark.parametrize("suffix", [".txt", ".json"])
def test_knots_need_a_place_too(tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str) -> None:
    assert "cannot be written" in error_of(["knot", "3_1", str(tmp_path / "no" / f"k{suffix}")], capsys)


def test_the_table_of_outputs_is_covered() -> None:
    assert set(OUTPUTS) - set(FORMATS) == {".blend", ".mp4", ".png"}  # these: tests/addon/pictures/test_export.py
