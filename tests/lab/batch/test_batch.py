"""Batches: a row and a folder for each run, whatever becomes of the others."""

import json
import os
import signal
import sys
import threading
from contextlib import nullcontext

import numpy as np
import pytest
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.collision.gap import thickness
from mobius_flow.core.curve.measures import writhe_and_crossings
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify
from mobius_flow.lab.batch import campaign, sandbox, single
from mobius_flow.lab.batch.job import Job
from mobius_flow.lab.batch.table import Row
from mobius_flow.lab.smooth.fourier import FourierCurve
from shapes import regular_polygon, torus_trefoil

TINY = ("--vertices", 40, "--max-iterations", 3)


def pick(rows, *columns):
    return [tuple(row[name] for name in columns) for row in rows]


def test_rows_and_folders(batch, ring, tmp_path, capsys):
    write_curve(tmp_path / "knot.obj", torus_trefoil(30))
    rows = batch(ring, tmp_path / "knot.obj", "L2a1", "--starts", 2, "--seed", 5, "--max-iterations", 3)
    captured = capsys.readouterr()
    shown = [line.split() for line in captured.out.splitlines()]
    assert shown[0] == ["name", "type", "energy", "certified", "s", "how", "it", "ended"]
    assert [row[:2] for row in shown[1:4]] == [["L2a1", "L2a1"], ["L2a1-2", "L2a1"], ["knot", "m3_1"]]
    assert [float(row[2]) for row in shown[1:7]] == pytest.approx([float(row["energy"]) for row in rows], rel=1e-4)
    assert captured.out.endswith(" -o gallery.png\n")
    assert f"\n✓ 6 runs      6 iteration limit\n  wrote       {tmp_path}/out/results.csv  " in captured.out
    assert captured.err == "6 runs\n"
    assert pick(rows, "name", "start", "seed") == [
        (name, start, seed) for name in ("L2a1", "knot", "ring") for start, seed in (("1", ""), ("2", "7"))
    ]
    assert pick(rows, "type_before", "type_after") == [
        (name, name) for name in ("L2a1", "m3_1", "unknot") for _ in range(2)
    ]
    assert {(row["certified"], row["verified"]) for row in rows} == {("True", "True")}
    assert {row["options"] for row in rows} == {'{"max_iterations": 3, "radius": "none", "seed": 5}'}
    assert {(row["proved"], row["iterations"], row["fallback_steps"]) for row in rows} == {("True", "3", "0")}
    assert all(float(row["processor_seconds"]) > 0.0 for row in rows)
    for row in rows:
        folder = tmp_path / "out" / (row["name"] + ("" if row["start"] == "1" else "-2"))
        report = json.loads((folder / "report.json").read_text())
        assert report["final_energy"] == float(row["energy"])
        assert report["blas_threads"] == 1
        curve = read_curve(folder / "curve.txt")
        assert len(curve) == int(row["vertices"])
        assert float(row["ropelength"]) == curve.length / thickness(curve)
        assert (float(row["writhe"]), float(row["average_crossing_number"])) == writhe_and_crossings(curve)
        assert verify(folder / "trajectory.npz").accepted
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        *("L2a1", "L2a1-2", "knot", "knot-2", "ring", "ring-2", "results.csv", "results.parquet")
    }


def test_what_another_batch_has_done_meanwhile_is_not_done_again(batch, ring, tmp_path, monkeypatch):
    (row,) = batch(ring, *TINY)
    made = json.loads((tmp_path / "out/ring/report.json").read_text())["recipe"]
    monkeypatch.setattr(single, "_relaxed", None)
    found = single.relaxed(Job(file=str(ring), folder=str(tmp_path / "out/ring"), **made))
    assert str(found.energy) == row["energy"]


def test_the_first_start_is_the_input_or_what_the_command_knot_makes_and_others_are_scrambled(batch, ring, tmp_path):
    batch(ring, "--starts", 3, "--vertices", 12, "--max-iterations", 0)
    given, *starts = (read_curve(tmp_path / f"out/{name}/curve.txt").vertices for name in ("ring", "ring-2", "ring-3"))
    assert np.array_equal(given, read_curve(ring).vertices)
    assert all(np.abs(start - given).max() > 0.1 for start in starts)
    assert not np.array_equal(*starts)
    start = knot("4_1")
    batch("4_1", "--vertices", len(start), "--max-iterations", 0)
    assert np.array_equal(read_curve(tmp_path / "out/4_1/curve.txt").vertices, start.vertices)


def test_parquet_holds_the_same(batch, ring, tmp_path):
    (tmp_path / "empty.txt").touch()
    rows = batch(ring, tmp_path / "empty.txt", *TINY)
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(tmp_path / "out/results.parquet")
    found = {name: str(table.schema.field(name).type) for name in ("name", "start", "energy", "index", "certified")}
    assert list(found.values()) == ["string", "int64", "double", "int64", "bool"]
    as_text = [{key: "" if value is None else str(value) for key, value in row.items()} for row in table.to_pylist()]
    assert as_text == rows


def test_extrapolated_energy_and_index(batch, tmp_path):
    (row,) = batch("3_1", "--vertices", 90, "--extrapolate", "--stability")
    report = json.loads((tmp_path / "out/3_1/report.json").read_text())
    assert row["index"] == str(report["negative_eigenvalues"])
    assert float(row["extrapolated_energy"]) == pytest.approx(74.4120428860, abs=1e-8)
    assert 0.0 < float(row["extrapolated_energy_error"]) < 1e-6
    assert FourierCurve.of_lists(report["smooth"]).modes == [36]


def test_links_are_pulled_tight_from_starts_that_compete(batch, tmp_path, capsys):
    (row,) = batch("L2a1", "--tighten", "--starts", 2, "--vertices", 100)
    assert (row["kind"], row["verified"], row["energy"], row["status"]) == ("tight", "True", "", "converged")
    assert 8.0 * np.pi < float(row["ropelength"]) < 8.0 * np.pi * 1.002
    assert "ropelength 25.1" in (tmp_path / "out/L2a1/curve.txt").read_text().splitlines()[0]
    assert f"{float(row['ropelength']):.7g}" in capsys.readouterr().out
    batch("L2a1", "--tighten", "--extrapolate", status=2)
    assert "leave one of both out" in capsys.readouterr().err


def test_starts_of_knots_of_the_table_are_of_several_kinds(batch, tmp_path):
    kinds = ["named", "smooth", "lattice", "drawn", "hopped"]
    for name, expected in (("m3_1", kinds), ("T(2,3)", ["named", "scrambled", "scrambled"])):
        rows = batch(name, "--starts", len(expected), "--max-iterations", 0)
        assert [row["kind"] for row in rows] == expected
        assert {row["type_before"] for row in rows} <= {name, "3_1"}
        assert len({row["energy"] for row in rows}) == len(rows)


def test_what_is_finished_is_not_repeated(batch, ring, tmp_path, monkeypatch):
    done = []
    run = campaign.outcomes

    def spied(submit, jobs):
        jobs = list(jobs)
        done.extend((job.name, job.start) for job in jobs)
        return run(submit, jobs)

    monkeypatch.setattr(campaign, "outcomes", spied)

    def again(*words):
        done.clear()
        rows = batch(ring, tmp_path / "bad.txt", "--starts", 2, *words)
        return sorted(done), rows

    (tmp_path / "bad.txt").write_text("0 0 0\n1 x 0\n")
    everything = [("bad", 1), ("bad", 2), ("ring", 1), ("ring", 2)]
    first = again(*TINY)
    assert first[0] == everything
    assert again(*TINY) == (everything[:2], first[1])  # what failed is tried again
    write_curve(tmp_path / "bad.txt", regular_polygon(9))
    assert again(*TINY)[0] == everything[:2]
    assert again(*TINY)[0] == []
    assert again(*TINY, "--time-limit", 1000)[0] == []
    assert again(*TINY, "--seed", 1)[0] == [("bad", 2), ("ring", 2)]
    assert again(*TINY, "--seed", 1, "--tolerance", "1e-3")[0] == everything
    assert again(*TINY, "--seed", 1, "--tolerance", "1e-3", "--hops", 1)[0] == everything
    assert again(*TINY, "--seed", 2, "--tolerance", "1e-3", "--hops", 1)[0] == everything  # hops have seeds too
    assert again(*TINY, "--seed", 1, "--tolerance", "1e-3")[0] == everything
    write_curve(ring, regular_polygon(13))
    assert again(*TINY, "--seed", 1, "--tolerance", "1e-3")[0] == everything[2:]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes with names")
def test_poisoned_inputs_are_rows(batch, ring, tmp_path, capsys):
    poison = tmp_path / "poison"
    poison.mkdir()
    os.mkfifo(poison / "pipe.txt")
    (poison / "broken.obj").symlink_to("nowhere")
    for name, text in {
        "cross.txt": "0 0 0\n1 0 0\n1 1 0\n0.5 -1 0\n",
        "empty.txt": "",
        "huge.vect": "VECT\n1 1000000000 1\n-1000000000\n1\n0 0 0\n",
        "nan.xyz": "0 0 0\n1 nan 0\n1 1 0\n",
        "two\nlines.json": "{}",
    }.items():
        (poison / name).write_text(text)
    rows = batch(poison, ring, "--starts", 2, *TINY)
    assert "\n– 16 runs     " in (shown := capsys.readouterr().out)
    assert " failed, " in shown
    told = {row["name"]: row["message"] for row in rows if row["status"] == "failed"}
    assert len(rows) == 16
    assert [row["name"] for row in rows if row["status"] != "failed"] == ["ring", "ring"]
    for name, reason in {
        "pipe": "not a regular file",
        "broken": "missing",
        "cross": "edge 1 of component 1 and edge 3 of component 1 touch",
        "empty": "empty",
        "huge": "3000000000 coordinates announced",
        "nan": "line 2",
        "two\nlines": r"two\nlines.json",
    }.items():
        assert reason in told[name]
        assert "\n" not in told[name]
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        *("ring", "ring-2", "results.csv", "results.parquet")
    }


def test_the_time_limit(batch, ring, tmp_path):
    """What was reached is kept, and done again where there is more time; what is finished is not."""
    short, shorter, longer = (("7_7", "--max-iterations", 3, "--time-limit", limit) for limit in (1e-3, 1e-4, 1000))
    curve = tmp_path / "out" / "7_7" / "curve.txt"
    assert pick(batch(*short), "status") == [("time_limit",)]
    written = curve.stat().st_mtime_ns
    assert pick(batch(*shorter), "status") == [("time_limit",)]
    assert curve.stat().st_mtime_ns == written
    assert pick(batch(*longer), "status") != [("time_limit",)]
    assert curve.stat().st_mtime_ns != written


def test_a_run_that_goes_on_after_its_time_limit_is_killed(batch, ring, tmp_path, monkeypatch):
    monkeypatch.setattr(sandbox, "GRACE", 0.0)
    told = pick(batch("7_7", "--time-limit", 1e-3), "status", "message")
    assert told == [("failed", "stopped after 0.002 s, long after its time limit")]
    monkeypatch.undo()
    assert pick(batch(ring, *TINY), "status") != [("failed",)]  # in a new process
    left = {path.name for path in (tmp_path / "out").iterdir() if path.suffix != ".partial"}  # killed while it wrote
    assert left == {"ring", "results.csv", "results.parquet"}


@pytest.mark.parametrize("deaths", [1, 3])
def test_a_killed_run_is_tried_again(deaths, batch, ring, tmp_path, monkeypatch):
    asked = []
    answer = sandbox.Sandbox._answer

    def killed(box, line=""):
        if line:
            asked.append(line)
            if len(asked) <= deaths:
                box._process.kill()
        return answer(box, line)

    monkeypatch.setattr(sandbox.Sandbox, "_answer", killed)
    (row,) = batch(ring, *TINY)
    assert len(asked) == min(deaths + 1, 3)
    assert (row["status"] == "failed") == (deaths == 3)
    assert ("3 tries failed: its process was killed by SIGKILL" in row["message"]) == (deaths == 3)
    assert (tmp_path / "out/ring").is_dir() == (deaths < 3)


def test_an_interrupt_leaves_the_table(batch, ring, monkeypatch, capsys):
    monkeypatch.setattr(campaign, "live", lambda *_: nullcontext(lambda _: os.kill(os.getpid(), signal.SIGINT)))
    rows = batch(ring, "3_1..8_21", *TINY, status=130)
    assert len(rows) == 1
    assert rows[0]["status"] != "failed"
    assert capsys.readouterr().err == "36 runs\nmobius-flow: interrupted\n"


def test_few_runs_are_submitted_at_a_time(scheduler, tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, "WINDOW", 3)
    monkeypatch.setattr(sandbox, "run", lambda job: Row.failure(job, "as asked for"))
    jobs = [Job(f"{k}", 1, None, None, None, f"{tmp_path}/{k}", {}, False) for k in range(20)]
    submitted = []
    with campaign.submitting(scheduler) as submit:

        def counted(*words):
            submitted.append(1)
            return submit(*words)

        for done, (job, row) in enumerate(campaign.outcomes(counted, jobs), 1):
            assert (row.name, row.message) == (job.name, "as asked for")
            assert len(submitted) <= done + 3
    assert done == 20 == len(submitted)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["3_1", "-o", ""], "output is empty; name the directory of the results"),
        (["3_1", "--starts", "0"], "starts is 0; it must be from 1 to 1000000000"),
        (["3_1", "--starts", "9" * 20], f"starts is {'9' * 20}; it must be from 1 to 1000000000"),
        (["3_1", "--seed", "-1"], "seed is -1; it must be 0 or more"),
        (["3_1", "--time-limit", "inf"], "time_limit is inf; it must be"),
        (["3_1", "--vertices", "2"], "vertices is 2"),
        (["none.txt"], "none.txt: there is no such file"),
        *((["3_1", "--scheduler", to], f"{to}: no Dask scheduler answers there")
          for to in ("tcp://127.0.0.1:9", "nonsense", "tls://127.0.0.1:9")),
        ([f"braid({','.join(['1'] * 151)})"], "cannot be a folder of results: File name too long; rename the input"),
    ],
)  # fmt: skip
def test_one_sentence(words, told, tmp_path, monkeypatch, refused):
    pytest.importorskip("distributed")
    monkeypatch.setattr(campaign, "_PATIENCE", 1.0)
    monkeypatch.chdir(tmp_path)
    threads = threading.enumerate()
    assert told in refused("batch", "-o", "out", *words)
    assert threading.enumerate() == threads, "a client that is left half made"


def test_a_table_that_cannot_be_written_is_told_before_the_work(tmp_path, monkeypatch, refused):
    monkeypatch.setattr(campaign, "submitting", lambda *_: pytest.fail("work for nothing"))
    (tmp_path / "results.parquet").mkdir()
    said = refused("batch", "3_1", "-o", tmp_path)
    assert f": {tmp_path}/results.parquet: is a directory; name a file\n" in said


@pytest.mark.parametrize("library", ["distributed", "pyarrow"])
def test_a_missing_library_is_named(library, tmp_path, monkeypatch, refused):
    monkeypatch.setitem(sys.modules, library, None)
    said = refused("batch", "3_1", "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:9")
    assert f"import of {library} halted" in said
    assert '".[lab]"' in said


def test_workers_of_another_version_are_refused(ring, tmp_path):
    row = single.relaxed(Job("ring", 1, None, str(ring), None, str(tmp_path / "out"), {}, False, version="0.0"))
    assert row.failed
    assert "and 0.0 is wanted" in row.message


def test_modules_where_it_is_called_are_not_its_own(batch, ring, tmp_path, monkeypatch):
    (tmp_path / "queue.py").write_text("raise RuntimeError\n")
    monkeypatch.chdir(tmp_path)
    with sandbox.closed():  # so that another child starts here
        pass
    assert pick(batch(ring, *TINY), "status") != [("failed",)]


def test_codes_in_files_and_names_that_are_no_text(batch, ring, tmp_path):
    (tmp_path / "trefoil.pd").write_text("PD[X[1,5,2,4], X[3,1,4,6], X[5,3,6,2]]")
    (tmp_path / "knot.stl").touch()
    odd = ring.with_name(os.fsdecode(b"n\xff.txt"))
    ring.rename(odd)
    rows = batch(tmp_path / "trefoil.pd", tmp_path / "knot.stl", odd, *TINY)
    assert pick(rows, "name", "type_before") == [("knot", ""), ("n\\xff", "unknot"), ("trefoil", "3_1")]
    assert "unknown suffix '.stl'" in rows[0]["message"]
    assert read_curve(tmp_path / "out" / "n\\xff" / "curve.txt")
