"""Batches on clusters: the default one, and one whose processes are started by hand."""

import socket
import sys
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from mobius_flow.cli import main
from mobius_flow.core import write_curve
from processes import finished, running
from shapes import regular_polygon

distributed = pytest.importorskip("distributed")
psutil = pytest.importorskip("psutil")  # which Dask needs too
PATIENCE = 300.0  # seconds


@pytest.fixture
def rings(tmp_path):
    place = tmp_path / "in"
    place.mkdir()
    for k in range(8):
        write_curve(place / f"ring{k}.txt", regular_polygon(8 + k))
    return place


def test_this_machine_s_cores_with_one_blas_thread_each(rings, tmp_path, monkeypatch, capfd, rows_of):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    assert main(["batch", str(rings), "-o", str(tmp_path / "out"), "--max-iterations", "1", "--vertices", "20"]) == 0
    said = capfd.readouterr()
    assert "\n✓ 8 runs      8 iteration limit\n" in said.out
    assert said.err == "8 runs\n"
    assert len(rows_of(tmp_path / "out")) == 8
    assert '"blas_threads": 1,' in (tmp_path / "out/ring3/report.json").read_text()


def command(*words):
    """Dask's command as the documents give it, on this machine alone."""
    return [sys.executable, "-m", "mobius_flow.lab.batch.dask", *words, "--host", "127.0.0.1"]


@pytest.fixture
def port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


@contextmanager
def cluster(port, workers, room):
    """The processes of a scheduler and of its workers, which have one thread each."""
    one = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(room))
    worker = command("worker", f"tcp://127.0.0.1:{port}", *one)
    scheduler = command("scheduler", "--port", str(port), "--no-dashboard")
    with ExitStack() as stack:
        yield [stack.enter_context(running(each)) for each in [scheduler] + [worker] * workers]


def wait_for_one(out):
    """Until there are the results of a run."""
    until = time.monotonic() + PATIENCE
    while not any(out.glob("ring*/")) and time.monotonic() < until:
        time.sleep(0.02)


@pytest.mark.slow
def test_a_worker_that_is_killed_costs_no_row(port, rings, tmp_path, rows_of):
    out = tmp_path / "out"
    words = ["batch", str(rings), "-o", str(out), "--scheduler", f"tcp://127.0.0.1:{port}"]
    program = [sys.executable, "-m", "mobius_flow", *words, "--vertices", "60", "--tolerance", "1e-9"]
    with cluster(port, 2, tmp_path) as processes, running(program) as process:
        wait_for_one(out)
        processes[1].kill()
        said, complained = process.communicate()
    assert process.returncode == 0
    assert "\n✓ 8 runs " in said
    assert "failed" not in said
    assert complained == ""
    assert [row["name"] for row in rows_of(out)] == [f"ring{k}" for k in range(8)]
    assert {path.name for path in out.iterdir()} == {*(f"ring{k}" for k in range(8)), "results.csv", "results.parquet"}


ORPHAN = """
import os, sys
from mobius_flow.lab.batch.sandbox import Sandbox
print(Sandbox()._process.pid, flush=True)
os._exit(0)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="looks at processes")
def test_children_end_with_their_parent():
    pid = finished([sys.executable, "-c", ORPHAN]).stdout.strip()
    until = time.monotonic() + PATIENCE
    while (left := _runs(pid)) and time.monotonic() < until:
        time.sleep(0.02)
    assert not left


def _runs(pid):
    try:
        return " Z " not in Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
