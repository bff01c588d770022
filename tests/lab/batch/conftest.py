"""One cluster for all tests of batches."""

import csv

import pytest
from mobius_flow.cli import main
from mobius_flow.core import write_curve
from mobius_flow.lab.batch import sandbox
from shapes import regular_polygon


@pytest.fixture(scope="session")
def scheduler(tmp_path_factory):
    """The address of a scheduler in this process, with one worker."""
    distributed = pytest.importorskip("distributed")
    one = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "memory_limit": 0}
    place = {"dashboard_address": "127.0.0.1:0", "local_directory": str(tmp_path_factory.mktemp("dask"))}
    with distributed.LocalCluster(**one, **place, worker_dashboard_address="127.0.0.1:0") as cluster:
        yield cluster.scheduler_address
        with sandbox.closed():
            pass


@pytest.fixture
def batch(scheduler, tmp_path):
    """Run a batch on it into tmp_path/out, and give the rows of its table."""

    def run(*words, status=0):
        out = tmp_path / "out"
        assert main(["batch", *map(str, words), "-o", str(out), "--scheduler", scheduler]) == status
        return table(out)

    return run


def table(out):
    """The rows of a batch's table."""
    with (out / "results.csv").open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture
def rows_of():
    return table


@pytest.fixture
def ring(tmp_path):
    path = tmp_path / "ring.txt"
    write_curve(path, regular_polygon(12))
    return path
