"""Benchmarks still fit the program they measure; what they measure is no matter for tests."""

import sys
from pathlib import Path

import pytest
from processes import finished

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"
ARGUMENTS = {
    "batch": ["many", "2"],
    "collision": ["60"],
    "hierarchy": ["60"],
    "hops": ["T34", "--hops", "1"],
    "metric": ["100"],
    "obstacles": ["--vertices", "60"],
    "repulsion": ["60", "--latitudes", "12"],
    "resolution": ["3_1"],
    "soak": ["--flows", "2"],
    "threads": ["3_1", "--max-iterations", "2"],
    "tries": ["T35", "--seeds", "1"],
}


def test_every_benchmark_is_tried():
    assert {path.stem for path in BENCHMARKS.glob("*.py")} == set(ARGUMENTS)


@pytest.mark.parametrize("name", ARGUMENTS)
def test_it_runs(name, tmp_path):
    done = finished([sys.executable, str(BENCHMARKS / f"{name}.py"), *ARGUMENTS[name]], cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    few = {"batch": 1, "soak": 1, "resolution": 3, "hops": 3, "tries": 3}
    least = few.get(name, 5)  # a title, and a line for each of four curves
    assert len(done.stdout.splitlines()) >= least
