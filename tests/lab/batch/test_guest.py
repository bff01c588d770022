"""A batch replaces its own files only, listens to nobody, and leaves nothing behind."""

import hashlib
import json
import os
import re
import shutil
import sys
import time
from contextlib import ExitStack, nullcontext
from functools import partial

import numpy as np
import pytest
from mobius_flow.cli import main
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, read_curve, write_curve
from mobius_flow.lab.batch import campaign, single
from mobius_flow.lab.batch.folder import new_folder
from mobius_flow.lab.batch.job import inputs, jobs
from processes import listening, running
from shapes import regular_polygon

pytest.importorskip("pyarrow")
psutil = pytest.importorskip("psutil")  # which Dask needs
PROGRAM = [sys.executable, "-m", "mobius_flow", "batch"]
QUICK = ["--vertices", "12", "--max-iterations", "0"]
OTHERWISE = ["--vertices", "24", "--max-iterations", "0"]  # by which results are to be replaced


@pytest.fixture(scope="module")
def relax_into(scheduler):
    """Run a batch on a file, into a directory; its exit status."""

    def run(source, out, *words):
        return main(["batch", str(source), "-o", str(out), "--scheduler", scheduler, *words])

    return run


@pytest.fixture(scope="module")
def results(tmp_path_factory, relax_into):
    """A directory of results, and the input beside it."""
    place = tmp_path_factory.mktemp("results")
    write_curve(place / "ring.txt", regular_polygon(12))
    assert relax_into(place / "ring.txt", place / "out", "--quiet", *QUICK) == 0
    return place


@pytest.fixture
def place(results, tmp_path):
    """A copy of it, to be spoiled."""
    shutil.copytree(results, tmp_path / "place")
    return tmp_path / "place"


def replaced_by(path, text):
    if path.is_dir():
        shutil.rmtree(path)
    path.unlink(missing_ok=True)
    path.write_text(text)


def moved_and_linked(path):
    path.rename(path.parents[1] / "elsewhere")
    path.symlink_to(path.parents[1] / "elsewhere")


def with_a_column(path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pq.read_table(path)
    pq.write_table(table.append_column("remark", pa.array(["mine"])), path)


def emptied(path, **files):
    shutil.rmtree(path)
    path.mkdir()
    for name, text in files.items():
        (path / name.replace("_", ".")).write_text(text)


def a_pipe(path):
    path.unlink()
    os.mkfifo(path)


FOREIGN = {
    "a folder with a thesis and a report": (
        "out/ring",
        partial(emptied, thesis_tex="x", report_json='{"row": {}, "recipe": {}}'),
    ),
    "results behind a link": ("out/ring", moved_and_linked),
    "a folder among results": ("out/ring/pictures", lambda path: path.mkdir()),
    "a curve that was edited": ("out/ring/curve.txt", lambda path: path.write_text(f"{path.read_text()}# mine\n")),
    "a trajectory of another program": ("out/ring/trajectory.npz", lambda path: replaced_by(path, "mine")),
    "a report that is a pipe": ("out/ring/report.json", a_pipe),
    "a table that is a link": ("out/results.csv", moved_and_linked),
    "someone's Parquet table": ("out/results.parquet", lambda path: replaced_by(path, "PAR1")),
    "a Parquet table with another column": ("out/results.parquet", with_a_column),
    "a file in place of the directory": ("out", lambda path: replaced_by(path, "mine")),
}


def everything(place):
    """What is in a directory, to the byte."""
    found = {}
    for path in sorted(place.rglob("*")):
        status = path.lstat()
        content = path.read_bytes() if path.is_file() else os.readlink(path) if path.is_symlink() else None
        found[str(path)] = (status.st_ino, status.st_mode, status.st_mtime_ns, content)
    return {name: each if "/out/" in name else each[::3] for name, each in found.items()}


@pytest.mark.skipif(os.name != "posix", reason="links and pipes")
@pytest.mark.parametrize(("path", "spoil"), FOREIGN.values(), ids=FOREIGN)
def test_what_is_not_its_own_is_refused_before_any_work(path, spoil, place, refused):
    spoil(place / path)
    if path == "out/results.csv" and (place / path).is_symlink():
        (place / "elsewhere").write_text("mine")
    before = everything(place)
    said = refused("batch", place / "ring.txt", "-o", place / "out", *OTHERWISE)
    assert said.startswith((f"mobius-flow: {place / path}: ", f"mobius-flow: {place / 'out/ring'}: "))
    assert "; move it, or name another directory" in said or path == "out"
    assert everything(place) == before


def test_results_are_replaced_and_other_files_are_left_alone(place, relax_into):
    (place / "out/notes").mkdir()
    for name in ("notes/thesis.tex", "notes.md", ".mobius-flow-mine.partial"):
        (place / "out" / name).write_text("mine")
    mine = {name: each for name, each in everything(place).items() if "/ring" not in name and "results." not in name}
    assert relax_into(place / "ring.txt", place / "out", "--quiet", *OTHERWISE) == 0
    assert json.loads((place / "out/ring/report.json").read_text())["options"]["vertices"] == 24
    assert mine.items() <= everything(place).items()
    assert len(everything(place)) == len(mine) + 7  # ring.txt, ring, its three files, and the tables


def test_what_arrives_during_the_work_survives(place):
    with ExitStack() as stack:
        stack.enter_context(pytest.raises(MobiusFlowError, match=r"thesis\.tex: was not written by"))
        stack.enter_context(new_folder(place / "out/ring"))
        (place / "out/ring/thesis.tex").write_text("mine")
        before = everything(place / "out/ring")
    assert everything(place / "out/ring") == before
    assert sorted(os.listdir(place / "out")) == ["results.csv", "results.parquet", "ring"]


def test_a_table_that_is_edited_during_the_work_survives(place, relax_into, monkeypatch, capsys):
    table = place / "out/results.csv"
    monkeypatch.setattr(campaign, "live", lambda *_: nullcontext(lambda _: table.write_text("mine")))
    words = [place / "ring.txt", place / "out", *OTHERWISE]
    assert relax_into(*words) == 2
    assert f"{table}: was not written by" in capsys.readouterr().err
    assert table.read_text() == "mine"
    table.unlink()
    monkeypatch.setattr(campaign, "live", lambda *_: nullcontext(lambda _: pytest.fail("done twice")))
    assert relax_into(*words) == 0
    assert "ring,1," in table.read_text()


def test_no_cell_is_a_formula(results, relax_into, tmp_path, rows_of):
    names = ["=1+1", "-2", "+3", "@SUM(A1)", "\t=1", "＝1"]
    for name in names:
        shutil.copy(results / "ring.txt", tmp_path / f"{name}.txt")
        (tmp_path / f"{name}2.txt").write_text("=1+1\n")  # is refused
    assert relax_into(tmp_path, tmp_path / "out", "--quiet", *QUICK) == 0
    rows = rows_of(tmp_path / "out")
    texts = [text for row in rows for text in row.values() if text and not re.fullmatch(r"-?[0-9.e+-]+", text)]
    assert not [text for text in texts if text[0] in "=+-@\t\r\n＝"]
    assert {row["name"] for row in rows if row["status"] == "converged"} == {f"_{name}" for name in names}
    assert {row["name"] for row in rows if row["status"] == "failed"} == {f"_{name}2" for name in names}
    assert read_curve(tmp_path / "out/_=1+1/curve.txt")


def test_a_curve_has_a_head(results, rows_of):
    first, second, _ = (results / "out/ring/curve.txt").read_text(encoding="utf-8").split("\n", 2)
    (row,) = rows_of(results / "out")
    assert first == f"# ring: unknot, Möbius energy {float(row['energy']):.9g}, converged"
    assert second == f"# mobius-flow {row['version']} batch, options {row['options']}"
    assert row["input_sha256"] == hashlib.sha256((results / "ring.txt").read_bytes()).hexdigest()


def test_a_curve_in_four_dimensions_is_refused_at_once(tmp_path, monkeypatch):
    write_curve(tmp_path / "a.json", Curve(np.pad(regular_polygon(12).vertices, ((0, 0), (0, 1)))))
    monkeypatch.setattr(single, "minimize", lambda *_: pytest.fail("work for nothing"))
    still = {"avoid": [], "pins": [], "pin_tangents": False}
    (job,) = jobs(inputs([str(tmp_path / "a.json")]), 1, tmp_path / "out", RelaxOptions(), still, False)
    row = single.relaxed(job)
    assert row.failed
    assert row.message.startswith(f"{tmp_path / 'a.json'}: the curve is in dimension 4, and curve.txt holds")


def test_it_listens_to_nobody_and_leaves_nothing_in_the_temporary_directory(tmp_path):
    temporary = tmp_path / "tmp"
    temporary.mkdir()
    words = [*PROGRAM, "9_1..9_3", "-o", str(tmp_path / "out")]
    with running(words, env=os.environ | {"TMPDIR": str(temporary)}) as process:
        while not psutil.Process(process.pid).children():
            assert listening(process) == set()
        for _ in range(8):
            assert listening(process) == set()
            time.sleep(0.1)
        process.terminate()
        _, said = process.communicate()
    assert process.returncode == 130, said
    assert os.listdir(temporary) == []
