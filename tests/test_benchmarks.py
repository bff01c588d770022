"""Benchmarks still fit the program they measure; what they measure is no matter for tests."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from processes import finished
from soak import flow
from speed import exponents

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"
ARGUMENTS = {
    "batch": ["many", "2"],
    "collision": ["curves", "60"],
    "hops": ["T34", "--hops", "1"],
    "knots": ["knots", "--only", "3_1,L2a1,unknot-rope", "--tolerance", "1e-2"],
    "morphs": ["--only", "ochiai"],
    "passes": ["goeritz"],
    "resolution": ["3_1"],
    "seeded_runs": ["different", "--save", "runs.json"],
    "soak": ["--count", "2"],
    "speed": ["--sizes", "60,80", "--solver", "hierarchical"],
}

PHASES = ["lists", "energy", "derivative", "metric", "gradient", "retract", "proof", "iteration"]


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
    few = {"batch": 1, "seeded_runs": 0, "soak": 1, "resolution": 3, "hops": 3, "passes": 3, "knots": 6}
    least = few.get(name, 5)  # a title, and a line for each of four curves
    assert len(done.stdout.splitlines()) >= least


@pytest.mark.slow
@pytest.mark.parametrize("words", [["obstacle", "60"], ["repulsion", "60", "--latitudes", "12"], ["motions", "22"]])
def test_the_other_tables_of_collisions(words):
    done = run("collision", *words)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) > 3


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "seed"), [*(("world", k) for k in range(30)), *(("drags", k) for k in range(3))])
def test_random_flows_among_obstacles_and_drags(kind, seed):
    assert flow(np.random.default_rng([2, seed]), kind) in ("ok", "refused")


@pytest.mark.slow
def test_a_knot_that_is_not_what_it_should_be_fails():
    done = run("knots", "knots", "--only", "3_1,unknot-lattice-20", "--max-iterations", "1")
    header, trefoil, unknot, _, _ = done.stdout.splitlines()
    assert header.split()[:3] == ["curve", "vertices", "type"]
    assert " kept " in trefoil
    assert "iteration_limit" in unknot
    assert done.returncode == 1
    done = run("knots", "primes", "--only", "unknot-20")
    assert (done.returncode, "is unknown" in done.stderr) == (2, True)


@pytest.mark.slow
def test_figures_of_speed():
    done = run("speed", "--sizes", "60,200", "--solver", "hierarchical", "--accuracy", "1e-3", "--json")
    report = json.loads(done.stdout)
    assert {"machine", "rows", "exponents", "options", "version", "blas_threads", "numpy", "scipy"} <= set(report)
    assert report["options"]["accuracy"] == 1e-3
    assert report["options"]["mesh"] == "fixed"
    for row, size in zip(report["rows"], (60, 200), strict=True):
        assert (row["vertices"], row["solver"]) == (size, "hierarchical")
        assert list(row["seconds"]) == PHASES
        assert row["in_copies"]["proof"] == row["seconds"]["proof"] / report["machine"]["copy"]
        assert row["peak_bytes"] > 0
        assert row["deviation"]["derivative"] < 1e-4
        assert 0.99 < row["deviation"]["cosine"] <= 1.0
    assert run("speed", "--sizes", "59").returncode == 2


def test_exponents_are_those_of_large_sizes_by_solver():
    sizes = {"dense": (200, 1999, 2000, 2500), "hierarchical": (3000, 5000, 9000), "sparse": (1000, 5000)}
    rows = [
        {"vertices": n, "solver": name, "seconds": {"iteration": 1e-5 * n**3 + (n < 2000)}}
        for name in sizes
        for n in sizes[name]
    ]
    assert exponents(rows) == {"dense": pytest.approx(3.0), "hierarchical": pytest.approx(3.0)}
