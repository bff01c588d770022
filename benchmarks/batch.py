"""Batches: what a second worker gains, and what ten thousand runs cost the process that submits them.

python benchmarks/batch.py workers              the same table on one worker and on two
python benchmarks/batch.py workers 3_1..6_3 3   names and starts
python benchmarks/batch.py many 10000           so many tiny runs; the peak memory of the submitter
"""

import resource
import sys
import tempfile
import time
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from pathlib import Path

from mobius_flow.cli import main as mobius_flow
from mobius_flow.core import write_curve
from mobius_flow.core.knots import knot


def processor_seconds() -> float:
    """Processor seconds of this process and of its children that have ended."""
    uses = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(use.ru_utime + use.ru_stime for use in uses)


def peak_megabytes() -> float:
    """The peak memory of this process."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1 << 10 if sys.platform != "darwin" else 1 << 20)


def workers(names: str = "3_1..6_3", starts: str = "3") -> None:
    """Print the seconds that one worker takes, and that two take."""
    from distributed import LocalCluster

    for count in (1, 2):
        before = processor_seconds()
        with (
            tempfile.TemporaryDirectory() as room,
            LocalCluster(n_workers=count, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster,
        ):
            began = time.perf_counter()
            words = ["batch", names, "--starts", starts, "-o", f"{room}/out", "--scheduler", cluster.scheduler_address]
            assert mobius_flow(words) == 0
            seconds = time.perf_counter() - began
        print(f"{count} workers: {seconds:.1f} s, {processor_seconds() - before:.1f} s of processor time", flush=True)


def many(count: str = "10000") -> None:
    """Print the peak memory of the process that submits a number of runs, which is this one."""
    with tempfile.TemporaryDirectory() as room:
        place = Path(room, "in")
        place.mkdir()
        for k in range(int(count)):
            write_curve(place / f"{k}.txt", knot("0_1", 12))
        before, began = peak_megabytes(), time.perf_counter()
        words = ["batch", str(place), "-o", f"{room}/out", "--vertices", "12", "--max-iterations", "0"]
        assert mobius_flow(words) == 0
        seconds = time.perf_counter() - began
    print(f"{peak_megabytes():.0f} MB at most, {before:.0f} MB before the first run; {seconds:.0f} s")


if __name__ == "__main__":
    parser = ArgumentParser(description=__doc__, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument("mode", choices=("workers", "many"))
    parser.add_argument("words", nargs="*")
    given = parser.parse_args()
    {"workers": workers, "many": many}[given.mode](*given.words)
