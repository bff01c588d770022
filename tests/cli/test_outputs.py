"""Outputs are looked at before the work, and kept elsewhere when writing fails after it."""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from mobius_flow.cli import main, places
from mobius_flow.cli import relax as relax_command
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.base.errors import MobiusFlowError
from mobius_flow.core.base.files import atomic_write
from mobius_flow.core.io import FORMATS
from mobius_flow.core.proof import verify
from shapes import regular_polygon, torus_trefoil

SHORT = ["--vertices", "60", "--max-iterations", "2", "--quiet"]


@pytest.fixture
def trefoil(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A curve in the working directory; temporary files go below it."""
    write_curve(tmp_path / "trefoil.txt", torus_trefoil(60))
    (tmp_path / "scratch").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "scratch"))
    return "trefoil.txt"


def refused(words: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> str:
    """The one line of a command that is refused before any work."""

    def working(*_arguments: object) -> None:
        raise AssertionError

    monkeypatch.setattr(relax_command, "relax", working)
    monkeypatch.setattr("mobius_flow.lab.compare.comparison._run", working)
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    return said


@pytest.mark.parametrize("alias", ["trefoil.txt", "./trefoil.txt", "hard.txt", "soft.txt", "TREFOIL"])
@pytest.mark.parametrize("option", ["OUT", "--report", "--trajectory", "compare"])
def test_the_input_is_no_output(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, alias: str, option: str
) -> None:
    os.link(trefoil, "hard.txt")
    os.symlink(trefoil, "soft.txt")
    alias = os.path.abspath(trefoil) if alias == "TREFOIL" else alias
    before = Path(trefoil).read_text()
    words = {"OUT": ["relax", trefoil, alias]}.get(option, ["relax", trefoil, "o.txt", option, alias])
    if option == "compare":
        os.rename(trefoil, "trefoil.json")
        os.symlink("trefoil.json", trefoil)
        words = ["compare", "trefoil.json", "-o", "trefoil.json"]
    assert "are the same file" in refused(words, capsys, monkeypatch)
    assert Path(trefoil).read_text() == before


@pytest.mark.parametrize("extras", [["--report", "./o.txt"], ["--report", "x", "--trajectory", "scratch/../x"]])
def test_outputs_are_files_of_their_own(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, extras: list[str]
) -> None:
    assert "are the same file" in refused(["relax", trefoil, "o.txt", *extras], capsys, monkeypatch)
    assert not os.path.exists("o.txt")


def test_devices_may_be_named_twice(trefoil: str) -> None:
    assert main(["relax", trefoil, "o.txt", "--report", os.devnull, "--trajectory", os.devnull, *SHORT]) == 0


@pytest.mark.parametrize("place", ["x" * 300 + ".txt", "trefoil.txt/o.txt", "o\0.txt", "y/" * 3000 + "o.txt"])
@pytest.mark.parametrize("option", ["OUT", "--report", "--trajectory", "compare", "knot"])
def test_places_that_cannot_be(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, place: str, option: str
) -> None:
    words = {
        "OUT": ["relax", trefoil, place],
        "compare": ["compare", trefoil, "-o", place.replace(".txt", ".csv")],
        "knot": ["knot", "3_1", place],
    }.get(option, ["relax", trefoil, "o.txt", option, place])
    assert "cannot be written" in refused(words, capsys, monkeypatch)


def test_what_an_output_cannot_hold_is_refused_before_the_work(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    write_curve("four.json", regular_polygon(30, dimension=4))
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    for output in ("o.txt", "o.obj", "o.vect", "o.blend", "o.mp4", "o.png"):
        assert output in refused(["relax", "four.json", output], capsys, monkeypatch)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--methods", "lbfgs,nonsense"], "unknown"),
        (["--methods", "lbfgs,lbfgs"], "give each of them once"),
        (["--methods", "cg", "--penalty", "3"], "penalty"),
        (["--methods", "lbfgs", "--metric", "nonsense"], "unknown"),
    ],
)
def test_compare_looks_at_all_methods_first(
    trefoil: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    expected: str,
) -> None:
    assert expected in refused(["compare", trefoil, "-o", "c.json", *words], capsys, monkeypatch)


def test_compare_looks_for_matplotlib_first(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert "need matplotlib" in refused(["compare", trefoil, "-o", "c.png"], capsys, monkeypatch)


@pytest.mark.skipif(os.name != "posix", reason="a new process")
def test_the_backend_of_matplotlib_does_not_matter(trefoil: str) -> None:
    pytest.importorskip("matplotlib")
    words = [
        sys.executable,
        "-P",
        "-m",
        "mobius_flow",
        "compare",
        trefoil,
        "-o",
        "c.svg",
        "--methods",
        "cg",
        *SHORT[:4],
    ]
    done = subprocess.run(words, env={**os.environ, "MPLBACKEND": "nonsense"}, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    assert Path("c.svg").stat().st_size > 1000


@pytest.fixture
def mounted(trefoil: str) -> Path:
    """A file that is mounted by itself over another one."""
    if sys.platform != "linux" or os.geteuid() != 0:
        pytest.skip("only the superuser mounts files")
    return Path("mounted")


def test_files_that_are_mounts(mounted: Path, trefoil: str) -> None:
    mounted.mkdir()
    names = ["o.txt", "r.json", "t.npz"]
    done = []
    try:
        for name in names:
            (mounted / name).write_text("old")
            Path(f"source-{name}").write_text("old")
            command = ["mount", "--bind", f"source-{name}", str(mounted / name)]
            if subprocess.run(command, capture_output=True, check=False).returncode:
                pytest.skip("no file can be mounted here")
            done.append(name)
        extras = ["--report", str(mounted / "r.json"), "--trajectory", str(mounted / "t.npz")]
        assert main(["relax", trefoil, str(mounted / "o.txt"), *extras, *SHORT]) == 0
        assert len(read_curve(mounted / "o.txt")) == 60
        assert json.loads(Path("source-r.json").read_text())["vertices"] == 60
        assert verify(mounted / "t.npz").accepted
        assert sorted(os.listdir(mounted)) == names
    finally:
        for name in done:
            subprocess.run(["umount", str(mounted / name)], check=True)


def test_a_file_in_a_directory_where_none_can_be_made(
    trefoil: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in a read-only directory, which does not stop the superuser of this test."""
    (tmp_path / "o.txt").write_text("old and rather long\n" * 1000)
    number = (tmp_path / "o.txt").stat().st_ino
    make = os.open

    def refusing(path: str, flags: int, mode: int = 0o777, **options: int) -> int:
        if flags & os.O_CREAT and Path(path).parent == tmp_path:
            raise PermissionError(13, "Permission denied")
        return make(path, flags, mode, **options)

    monkeypatch.setattr(os, "open", refusing)
    assert main(["relax", trefoil, "o.txt", *SHORT]) == 0
    assert len(read_curve("o.txt")) == 60
    assert os.stat("o.txt").st_ino == number
    assert os.listdir("scratch") == []


def test_copying_that_fails_brings_the_old_contents_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "a.txt"
    target.write_text("old")
    write = os.write

    def full(descriptor: int, data: bytes) -> int:
        if bytes(data) == b"new and longer":
            write(descriptor, b"new ")
            raise OSError(28, "No space left on device")
        return write(descriptor, data)

    monkeypatch.setattr("mobius_flow.core.base.files._replace", lambda *_: False)
    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OSError, match="No space"), atomic_write(target) as temporary:
        temporary.write_text("new and longer")
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def kept_as(said: str) -> list[str]:
    return re.findall(r"the result is kept as ([^)]+)\)", said)


def test_results_without_room_are_kept_elsewhere(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The directory disappears during the run."""
    os.mkdir("place")
    finish = relax_command.finish

    def disappearing(*arguments: object) -> object:
        result = finish(*arguments)  # type: ignore[arg-type]
        os.rmdir("place")
        return result

    monkeypatch.setattr(relax_command, "finish", disappearing)
    extras = ["--report", "place/r.json", "--trajectory", "place/t.npz"]
    assert main(["relax", trefoil, "place/o.obj", *extras, *SHORT]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    report, trajectory, curve = kept_as(said)
    assert json.loads(Path(report).read_text())["vertices"] == 60
    assert verify(trajectory).accepted
    assert len(read_curve(curve)) == 60


def test_of_a_film_that_fails_the_curve_is_kept(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(*_arguments: object) -> None:
        raise MobiusFlowError("film.mp4: cannot be written: no")

    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", failing)
    assert main(["relax", trefoil, "film.mp4", *SHORT]) == 2
    (curve,) = kept_as(capsys.readouterr().err)
    assert curve.endswith("film.obj")
    assert len(read_curve(curve)) == 60


def test_how_films_are_played_reaches_them_and_nothing_else(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    played = []
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", lambda *arguments: played.append(arguments[-1]))
    assert main(["relax", trefoil, "film.mp4", "--loop", "--quiet", *SHORT]) == 0
    assert (played[0].loop, played[0].constant_radius) == (True, False)
    for out in ("o.obj", "o.png"):
        assert main(["relax", trefoil, out, "--constant-radius", *SHORT]) == 2
        assert capsys.readouterr().err == "mobius-flow: --loop and --constant-radius are for .blend, .mp4\n"


def test_what_cannot_be_kept_leaves_nothing(trefoil: str) -> None:
    def failing(path: str) -> None:
        if Path(path).parent.is_dir():
            Path(path).write_text("half")
        raise MobiusFlowError("no")

    assert places.kept("nowhere/o.txt", failing) == ["no"]
    assert os.listdir("scratch") == []


def written_formats(command: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """The suffixes that the help of a command has at OUT."""
    assert main([command, "--help"]) == 0
    (told,) = re.findall(r"\n  OUT +(.*?)\s+or\s+-", capsys.readouterr().out, re.DOTALL)
    return re.findall(r"\.\w+", told)


@pytest.mark.parametrize("command", ["relax", "knot"])
def test_formats_that_are_only_read_are_no_outputs(
    command: str, trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    told = written_formats(command, capsys)
    curve = regular_polygon(12)
    for suffix in set(FORMATS) & set(told):
        if suffix != ".pd":  # which has no circles
            assert FORMATS[suffix].text(curve)
    only_read = set(FORMATS) - set(told)
    assert only_read == {".dt", ".pdb", ".cif"}
    for words in (["o.dt"], ["-", "--format", "dt"]):
        assert refused([command, trefoil if command == "relax" else "3_1", *words], capsys, monkeypatch)
    assert not Path("o.dt").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["o.png", "--look", "neno"], "did you mean neon"),
        (["o.obj", "--look", "neon"], "--look is for .blend, .mp4, .png"),
    ],
)
def test_looks_are_known_ones_and_of_scenes(
    trefoil: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, words: list[str], said: str
) -> None:
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    assert said in refused(["relax", trefoil, *words], capsys, monkeypatch)
