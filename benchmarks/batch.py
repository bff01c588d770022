"""Batches: what a second worker gains, and what ten thousand runs cost the process that submits them.

python benchmarks/batch.py workers              the same table on one worker and on two, started by hand
python benchmarks/batch.py workers 3_1..6_3 3   names and starts
python benchmarks/batch.py many 10000           so many tiny runs; the peak memory of the submitter
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
from mobius_flow.cli import main as mobius_flow
from mobius_flow.core import Curve, write_curve

CORNERS = 12  # of the tiny inputs


def processor_seconds() -> float:
    """Processor seconds of this process and of its children that have ended."""
    return sum(
        use.ru_utime + use.ru_stime for use in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


@contextmanager
def cluster(workers: int, room: Path):
    """The address of a scheduler on this machine, with workers of one thread each."""
    program = [sys.executable, "-m"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    path = room / "scheduler.json"
    commands = [[*program, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]] + workers * [
        [*program, "distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny", "--local-directory", str(room)]
    ]
    with ExitStack() as stack:
        for command in commands:
            process = subprocess.Popen([*command, "--scheduler-file", str(path), "--no-dashboard"], **quiet)
            stack.callback(process.wait)
            stack.callback(process.terminate)
        yield address_in(path)


def address_in(path: Path) -> str:
    """What a scheduler has written into its file."""
    while True:
        try:
            return json.loads(path.read_text())["address"]
        except (OSError, ValueError):
            time.sleep(0.1)


def workers(names: str = "3_1..6_3", starts: str = "3") -> None:
    """Print the seconds that one worker takes, and that two take."""
    from distributed import Client

    for count in (1, 2):
        before = processor_seconds()
        with tempfile.TemporaryDirectory() as room, cluster(count, Path(room)) as address:
            with Client(address) as client:
                client.wait_for_workers(count)
            began = time.perf_counter()
            words = ["batch", names, "--starts", starts, "-o", f"{room}/out", "--scheduler", address]
            assert mobius_flow(words) == 0
            seconds = time.perf_counter() - began
        print(f"{count} workers: {seconds:.1f} s, {processor_seconds() - before:.1f} s of processor time", flush=True)


def many(count: str = "10000") -> None:
    """Print the peak memory of the process that submits a number of runs, which is this one."""
    angles = 2.0 * np.pi * np.arange(CORNERS) / CORNERS
    circle = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    with tempfile.TemporaryDirectory() as room:
        place = Path(room, "in")
        place.mkdir()
        write_curve(place / "0.txt", Curve(circle))
        text = (place / "0.txt").read_text()
        for k in range(1, int(count)):
            (place / f"{k}.txt").write_text(text)
        before, began = peak_megabytes(), time.perf_counter()
        words = ["batch", str(place), "-o", f"{room}/out", "--vertices", f"{CORNERS}", "--max-iterations", "0"]
        assert mobius_flow(words) == 0
        seconds = time.perf_counter() - began
    print(f"{peak_megabytes():.0f} MB at most, {before:.0f} MB before the first run; {seconds:.0f} s")


def peak_megabytes() -> float:
    """The peak memory of this process."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1 << 10 if sys.platform != "darwin" else 1 << 20)


if __name__ == "__main__":
    parser = ArgumentParser(description=__doc__, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument("mode", choices=("workers", "many"))
    parser.add_argument("words", nargs="*")
    given = parser.parse_args()
    {"workers": workers, "many": many}[given.mode](*given.words)
