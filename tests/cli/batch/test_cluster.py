"""Batches on clusters: the default one, and one whose processes are started by hand."""

import csv
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
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


def table(path: Path) -> list[dict[str, str]]:
    with (path / "results.csv").open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture
def rings(tmp_path: Path) -> Path:
    place = tmp_path / "in"
    place.mkdir()
    for k in range(8):
        write_curve(place / f"ring{k}.txt", regular_polygon(8 + k))
    return place


def test_this_machine_s_cores_with_one_blas_thread_each(
    rings: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    assert main(["batch", str(rings), "-o", str(tmp_path / "out"), "--max-iterations", "1", "--vertices", "20"]) == 0
    assert capfd.readouterr() == ("8 runs: 8 iteration limit\n", "")
    assert len(table(tmp_path / "out")) == 8
    assert '"blas_threads": 1,' in (tmp_path / "out/ring3/report.json").read_text()


def command(program: str, *words: str) -> list[str]:
    """A program of Dask, without its dashboard."""
    return [sys.executable, "-m", "distributed.cli." + program, *words, "--no-dashboard"]


@pytest.fixture
def port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


@contextmanager
def cluster(port: int, workers: int, room: Path) -> Iterator[list["subprocess.Popen[str]"]]:
    """The processes of a scheduler and of its workers, which have one thread each."""
    one = ("--nthreads", "1", "--no-nanny", "--local-directory", str(room))
    worker = command("dask_worker", f"tcp://127.0.0.1:{port}", *one)
    scheduler = command("dask_scheduler", "--host", "127.0.0.1", "--port", str(port))
    with ExitStack() as stack:
        yield [stack.enter_context(running(each)) for each in [scheduler] + [worker] * workers]


def wait_for_one(out: Path) -> None:
    """Until there are the results of a run."""
    until = time.monotonic() + PATIENCE
    while not any(out.glob("ring*/")) and time.monotonic() < until:
        time.sleep(0.02)


def test_a_worker_that_is_killed_costs_no_row(port: int, rings: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ["batch", str(rings), "-o", str(out), "--scheduler", f"tcp://127.0.0.1:{port}"]
    program = [sys.executable, "-m", "mobius_flow", *words, "--vertices", "60", "--tolerance", "1e-9"]
    with cluster(port, 2, tmp_path) as processes, running(program) as process:
        wait_for_one(out)
        processes[1].kill()
        said, complained = process.communicate()
    assert process.returncode == 0
    assert said.startswith("8 runs: ")
    assert "failed" not in said
    assert complained == ""
    assert [row["name"] for row in table(out)] == [f"ring{k}" for k in range(8)]
    assert {path.name for path in out.iterdir()} == {*(f"ring{k}" for k in range(8)), "results.csv", "results.parquet"}


def test_an_interrupt_leaves_nothing_on_the_cluster(port: int, rings: Path, tmp_path: Path) -> None:
    out, address = tmp_path / "out", f"tcp://127.0.0.1:{port}"
    words = ["batch", str(rings), "7_1..8_21", "-o", str(out), "--scheduler", address]
    with cluster(port, 1, tmp_path) as processes, running([sys.executable, "-m", "mobius_flow", *words]) as process:
        wait_for_one(out)
        process.send_signal(signal.SIGINT)
        said = process.communicate()
        assert (process.returncode, *said) == (130, "", "mobius-flow: interrupted\n")
        done = [row["status"] for row in table(out)]
        assert done
        assert "failed" not in done
        with distributed.Client(address) as client:
            until = time.monotonic() + PATIENCE
            while (left := client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks))) and (
                time.monotonic() < until
            ):
                time.sleep(0.02)
        assert left == 0
        children = psutil.Process(processes[1].pid).children()
    assert len(children) == 1  # it lives on as long as its worker, and no longer
    assert psutil.wait_procs(children, timeout=PATIENCE)[1] == []


def test_a_lost_scheduler_leaves_the_table(port: int, rings: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ["batch", str(rings), "7_1..8_21", "-o", str(out), "--scheduler", f"tcp://127.0.0.1:{port}"]
    program = [sys.executable, "-m", "mobius_flow", *words, "--max-iterations", "3"]
    with cluster(port, 1, tmp_path) as processes, running(program) as process:
        wait_for_one(out)
        processes[0].kill()
        said = process.communicate()
    assert said[0] == ""
    assert said[1].startswith("mobius-flow: the Dask scheduler is lost")
    assert process.returncode == 2
    assert table(out)


ORPHAN = """
import os, sys
from mobius_flow.cli.batch.sandbox import Sandbox
print(Sandbox()._process.pid, flush=True)
os._exit(0)
"""


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="looks at processes")
def test_children_end_with_their_parent() -> None:
    pid = finished([sys.executable, "-c", ORPHAN]).stdout.strip()
    until = time.monotonic() + PATIENCE
    while (left := _runs(pid)) and time.monotonic() < until:
        time.sleep(0.02)
    assert not left


def _runs(pid: str) -> bool:
    try:
        return " Z " not in Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
