"""Benchmarks still fit the program they measure; what they measure is no matter for tests."""

import json
import sys
from pathlib import Path

import pytest
from processes import finished
from step_costs import Row, exponents

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"
ARGUMENTS = {
    "batch": ["many", "2"],
    "collision": ["60"],
    "drags": ["10"],
    "hops": ["T34", "--hops", "1"],
    "knots": ["knots", "--only", "3_1,L2a1,unknot-rope", "--tolerance", "1e-2"],
    "morphs": ["--only", "ochiai"],
    "obstacles": ["--vertices", "60"],
    "passes": ["goeritz"],
    "repulsion": ["60", "--latitudes", "12"],
    "resolution": ["3_1"],
    "seeded_runs": ["different", "--save", "runs.json"],
    "soak": ["--flows", "2"],
    "speed": ["--sizes", "60,80", "--solver", "hierarchical"],
}

PHASES = ["lists", "energy", "derivative", "metric", "gradient", "retract", "proof", "iteration"]


def test_every_benchmark_is_tried():
    assert {path.stem for path in BENCHMARKS.glob("*.py")} - {"step_costs", "words"} == set(ARGUMENTS)


def run(name, *arguments):
    return finished([sys.executable, str(BENCHMARKS / f"{name}.py"), *arguments])


QUICK = {"collision", "obstacles"}
NAMES = [pytest.param(each, marks=() if each in QUICK else pytest.mark.slow) for each in ARGUMENTS]


@pytest.mark.parametrize("name", NAMES)
def test_it_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(name, *ARGUMENTS[name])
    assert done.returncode == 0, done.stdout + done.stderr
    few = {"batch": 1, "seeded_runs": 0, "soak": 1, "resolution": 3, "hops": 3, "knots": 6}
    least = few.get(name, 5)  # a title, and a line for each of four curves
    assert len(done.stdout.splitlines()) >= least


@pytest.mark.parametrize("name", ["batch", "collision", pytest.param("passes", marks=pytest.mark.slow)])
def test_it_explains_itself(name):
    done = run(name, "--help")
    assert done.returncode == 0
    assert done.stdout.startswith(f"usage: {name}.py")


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
    rows = [Row(n, name, {"iteration": 1e-5 * n**3 + (n < 2000)}, 0, None) for name in sizes for n in sizes[name]]
    assert exponents(rows) == {"dense": pytest.approx(3.0), "hierarchical": pytest.approx(3.0)}
