"""Benchmarks still fit the program they measure; what they measure is no matter for tests."""

import sys
from pathlib import Path

import pytest
from processes import finished

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"
ARGUMENTS = {
    "bundles": ["1"],
    "collision": ["curves", "60"],
    "hops": ["T34", "--hops", "1"],
    "knots": ["knots", "--only", "3_1,L2a1,unknot-rope", "--tolerance", "1e-2"],
    "morphs": ["--only", "ochiai"],
    "resolution": ["3_1"],
    "rope": ["4_1", "--vertices", "80", "--iterations", "20"],
    "seeded_runs": ["different", "--save", "runs.json"],
    "untangling": ["culprit"],
    "speed": ["--sizes", "60,80", "--solver", "hierarchical"],
}


def test_every_benchmark_is_tried():
    assert {path.stem for path in BENCHMARKS.glob("*.py")} - {"hard_curves"} == set(ARGUMENTS)


def run(name, *arguments):
    return finished([sys.executable, str(BENCHMARKS / f"{name}.py"), *arguments])


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=() if each == "collision" else pytest.mark.slow) for each in ARGUMENTS]
)
def test_it_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(name, *ARGUMENTS[name])
    assert done.returncode == 0, done.stdout + done.stderr
    few = {"seeded_runs": 0, "untangling": 2, "resolution": 3, "hops": 3, "rope": 3, "collision": 3, "knots": 6}
    least = few.get(name, 5)  # a title, and a line for each curve
    assert len(done.stdout.splitlines()) >= least


@pytest.mark.slow
def test_collisions_with_an_obstacle_are_measured():
    done = run("collision", "obstacle", "60")
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) > 3
