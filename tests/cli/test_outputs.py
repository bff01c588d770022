"""Outputs are looked at before the work, and kept elsewhere when writing fails after it."""

import json
import os
import re
import tempfile
from pathlib import Path

import pytest
from commands import SHORT
from mobius_flow.cli import places
from mobius_flow.cli import relax as relax_command
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.base import OutputError, atomic_write
from mobius_flow.core.base.errors import MobiusFlowError
from mobius_flow.core.io import FORMATS
from mobius_flow.core.proof import verify
from shapes import regular_polygon

OUTPUTS = {
    "OUT": "relax trefoil.txt {}",
    "--report": "relax trefoil.txt o.txt --report {}",
    "--trajectory": "relax trefoil.txt o.txt --trajectory {}",
    "knot": "knot 3_1 {}",
    "compare": "compare trefoil.txt -o {}",
    "atlas": "atlas results -o {}",
    "list": "knot list.txt {}",
    "batch": "batch 3_1 -o {}",
}
FILES = [*OUTPUTS][:4]
ALL = [
    *["relax", "trefoil.txt", "place/o.txt", "--report", "place/r.json", "--trajectory", "place/t.npz", "--quiet"],
    *SHORT,
]

pytestmark = pytest.mark.usefixtures("room")


@pytest.fixture
def idle(monkeypatch):
    """No work is done: what is refused is so before."""

    def working(*_):
        raise AssertionError

    monkeypatch.setattr(relax_command, "relax", working)
    monkeypatch.setattr("mobius_flow.lab.compare.comparison._run", working)
    monkeypatch.setattr(places.export, "require_blender", lambda: None)


def words(output, place):
    return [word.format(place) for word in OUTPUTS[output].split()]


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("no/such/o.txt", "the directory no/such does not exist"),
        ("directory.txt", ": is a directory; name a file"),
        ("./trefoil.txt/o.txt", "cannot be written"),
        ("x" * 300 + ".txt", "cannot be written"),
        ("y/" * 3000 + "o.txt", "cannot be written"),
        ("o\0.txt", "cannot be written"),
    ],
)
@pytest.mark.parametrize("output", [*FILES, "compare"])
def test_places_where_no_file_can_be(output, place, said, refused):
    suffix = ".csv" if output == "compare" else ".txt"
    os.mkdir(f"directory{suffix}")
    before = sorted(os.listdir())
    assert said in refused(*words(output, place.replace(".txt", suffix)))
    assert sorted(os.listdir()) == before


def test_what_cannot_be_kept_leaves_the_temporary_directory_alone(refused, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(room := tmp_path / "temporary"))
    room.mkdir()
    (room / "others.txt").touch()
    assert "name a file" in refused("relax", "trefoil.txt", "o.txt", "--report", "")

    def failing(_path):
        raise MobiusFlowError("no")

    assert [places.kept(path, failing) for path in ("", "no/such/")] == [["no"], ["no"]]
    assert os.listdir(room) == ["others.txt"]


@pytest.mark.parametrize("output", ["atlas", "list", "batch"])
def test_a_directory_that_cannot_be_written_is_noticed_before_any_work(output, refused):
    """As in one that is read-only, which does not stop the superuser of this test."""
    Path("list.txt").write_text("3_1\n")
    Path("file").touch()
    assert "file/out: cannot be written" in refused(*words(output, "file/out"))


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize(
    ("alias", "output"),
    [
        *((alias, "OUT") for alias in ("trefoil.txt", "./trefoil.txt", "hard.txt", "soft.txt", "TREFOIL")),
        *(("soft.txt", output) for output in ("--report", "--trajectory", "compare")),
        ("./o.txt", "--report"),
        ("room/../o.txt", "--trajectory"),
    ],
)
def test_no_file_is_named_twice(alias, output, room, refused):
    os.mkdir("room")
    os.link("trefoil.txt", "hard.txt")
    os.symlink("trefoil.txt", "soft.txt")
    before = Path("trefoil.txt").read_text()
    if output == "compare":
        os.link("trefoil.txt", alias := "hard.csv")
    assert "are the same file" in refused(*words(output, str(room / "trefoil.txt") if alias == "TREFOIL" else alias))
    assert Path("trefoil.txt").read_text() == before
    assert not os.path.exists("o.txt")


def test_devices_may_be_named_twice(run):
    devices = ["--report", os.devnull, "--trajectory", os.devnull]
    assert run("relax", "trefoil.txt", "o.txt", *devices, *SHORT, "--quiet") == (0, "", "")


@pytest.mark.usefixtures("idle")
def test_what_an_output_cannot_hold_is_refused_before_the_work(refused):
    write_curve("four.json", regular_polygon(30, dimension=4))
    for output in ("o.txt", "o.obj", "o.vect", "o.blend", "o.mp4", "o.png"):
        assert output in refused("relax", "four.json", output)


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("relax trefoil.txt o.png --look neno", "did you mean neon"),
        ("relax trefoil.txt o.obj --look neon", "--look is for .blend, .mp4, .png"),
        ("relax trefoil.txt o.obj --loop", "mobius-flow: --loop and --constant-radius are for .blend, .mp4\n"),
        ("relax trefoil.txt o.png --constant-radius", "--loop and --constant-radius are for .blend, .mp4\n"),
        ("relax trefoil.txt o.stl", "; mobius-flow view makes .stl of one of those\n"),
        ("relax trefoil.txt o.npz", "; --trajectory writes motions\n"),
        ("compare trefoil.txt -o c.json --methods lbfgs,nonsense", "unknown"),
        ("compare trefoil.txt -o c.json --methods lbfgs,lbfgs", "give each of them once"),
        ("compare trefoil.txt -o c.json --methods cg --penalty 3", "penalty"),
        ("compare trefoil.txt -o c.json --methods lbfgs --metric nonsense", "unknown"),
    ],
)
def test_what_no_output_can_be_is_refused_before_the_work(command, said, refused):
    assert said in refused(*command.split())


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize("command", ["relax", "knot"])
def test_formats_that_are_only_read_are_no_outputs(command, run, refused):
    (told,) = re.findall(r"\n  OUT +(.*?)\s+or\s+-", run(command, "--help")[1], re.DOTALL)
    assert set(FORMATS) - set(re.findall(r"\.\w+", told)) == {".dt", ".pdb", ".cif"}
    for output in (["o.dt"], ["-", "--format", "dt"]):
        refused(command, "trefoil.txt" if command == "relax" else "3_1", *output)
    assert not Path("o.dt").exists()


def test_a_file_in_a_directory_where_none_can_be_made(room, scratch, monkeypatch, run):
    """As in a read-only directory, which does not stop the superuser of this test."""
    Path("o.txt").write_text("old and rather long\n" * 1000)
    number, make = os.stat("o.txt").st_ino, os.open

    def refusing(path, flags, mode=0o777, **options):
        if flags & os.O_CREAT and Path(path).parent == room:
            raise PermissionError(13, "Permission denied")
        return make(path, flags, mode, **options)

    monkeypatch.setattr(os, "open", refusing)
    assert run("relax", "trefoil.txt", "o.txt", *SHORT, "--quiet")[0] == 0
    assert len(read_curve("o.txt")) == 60
    assert os.stat("o.txt").st_ino == number
    assert os.listdir(scratch) == []


def test_copying_that_fails_brings_the_old_contents_back(tmp_path, monkeypatch):
    target, write = tmp_path / "a.txt", os.write
    target.write_text("old")
    before = sorted(os.listdir(tmp_path))

    def full(descriptor, data):
        if bytes(data) == b"new and longer":
            write(descriptor, b"new ")
            raise OSError(28, "No space left on device")
        return write(descriptor, data)

    def mounted(*_):
        raise OSError(16, "Device or resource busy")

    monkeypatch.setattr(os, "replace", mounted)
    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OutputError, match="No space"), atomic_write(target) as temporary:
        temporary.write_text("new and longer")
    assert target.read_text() == "old"
    assert sorted(os.listdir(tmp_path)) == before


def test_results_without_room_are_kept_elsewhere(refused, monkeypatch):
    os.mkdir("place")
    finish = relax_command.finish

    def disappearing(*arguments):
        result = finish(*arguments)
        os.rmdir("place")
        return result

    monkeypatch.setattr(relax_command, "finish", disappearing)
    report, trajectory, curve = re.findall(r"the result is kept as ([^)]+)\)", refused(*ALL))
    assert json.loads(Path(report).read_text())["vertices"] == 60
    assert verify(trajectory).accepted
    assert len(read_curve(curve)) == 60


def test_of_a_film_that_fails_the_curve_is_kept_and_how_it_is_played_reaches_it(refused, monkeypatch):
    played = []

    def failing(*arguments):
        played.append(arguments[-1])
        raise MobiusFlowError("film.mp4: cannot be written: no")

    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", failing)
    said = refused("relax", "trefoil.txt", "film.mp4", "--loop", "--quiet", *SHORT)
    (curve,) = re.findall(r"the result is kept as ([^)]+)\)", said)
    assert curve.endswith("film.obj")
    assert len(read_curve(curve)) == 60
    assert (played[0].loop, played[0].constant_radius) == (True, False)


def test_what_cannot_be_kept_leaves_nothing(scratch):
    def failing(path):
        if Path(path).parent.is_dir():
            Path(path).write_text("half")
        raise MobiusFlowError("no")

    assert places.kept("nowhere/o.txt", failing) == ["no"]
    assert os.listdir(scratch) == []
