"""The checker: a single file that accepts runs, and refuses what was tuned to be overlooked.

That it decides as the program does is tested in `test_decisions`, and that it decides about whole files as ``verify``
does wherever a test calls that: see `second_opinion`.
"""

import ast
import subprocess
import sys
from pathlib import Path

import degenerate_motions
import numpy as np
import pytest
from mobius_flow.core import Curve, Task, Trajectory, relax
from mobius_flow.core.driver import RelaxOptions
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import checker
from solids import box, rod
from trajectory_files import checked, trajectory

CHECKER = Path(checker.__file__)


def test_it_needs_nothing_but_the_standard_library():
    tree = ast.parse(CHECKER.read_text())
    found = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    found |= {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert {name.partition(".")[0] for name in found} <= sys.stdlib_module_names


RUNS = {
    "a knot, its mesh being refined": (lambda: Task(curve=knot("4_1", 60)), {"mesh": "adaptive", "max_iterations": 14}),
    "a link": (lambda: Task(curve=knot("L5a1", 80)), {"max_iterations": 8}),
    "arcs and pins": (lambda: Task(curve=knot("overhand", 60), pins=(0, 59)), {"max_iterations": 6}),
    "obstacles": (lambda: Task(curve=ring(), obstacles=(rod(0.0, 0.0), box(2.0, 3.0))), {"max_iterations": 6}),
    "strand moves": (lambda: Task(curve=knot("goeritz")), {"untangle": "always", "max_iterations": 4}),
    "growth": (lambda: Task(curve=knot("3_1", 60)), {"grow": 1.3, "max_iterations": 10}),
}


def ring():
    angle = 2 * np.pi * np.arange(40) / 40
    return Curve(np.stack([1.5 * np.cos(angle), np.sin(angle), 0.2 * np.sin(2 * angle)], axis=1))


@pytest.mark.parametrize("name", RUNS)
def test_runs_are_accepted_forwards_and_backwards(name, tmp_path):
    task, settings = RUNS[name]
    task = task()
    record = Trajectory(obstacles=task.obstacles)
    for iterate in relax(task, RelaxOptions(**settings)):
        record.add(iterate)
    arrays = record.arrays()
    last = sum(key.startswith("stage_") for key in arrays) - 1
    backwards = {}
    for key, array in arrays.items():
        kind, _, number = key.rpartition("_")
        turned = array[::-1] if kind == "stage" else array
        backwards[f"{kind}_{last - int(number):03d}" if kind.startswith(("stage", "component")) else key] = turned
    for each in (arrays, backwards):
        verdict = checked(tmp_path, each, np.savez_compressed)  # by the checker alone, too, see above
        assert verdict.accepted, str(verdict)


def test_crossings_that_were_tuned_to_be_overlooked_are_refused(tmp_path):
    rng = np.random.default_rng(51)
    for _ in range(5):
        frames = degenerate_motions.tied_windows(rng)
        assert not checked(tmp_path, trajectory(([2] * degenerate_motions.ARCS, frames), opened=True)).accepted


def test_the_command_says_which_and_why(tmp_path):
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    np.savez(tmp_path / "good.npz", **trajectory([square, 2 * square]))
    np.savez(tmp_path / "bad.npz", **trajectory([square, -square]))
    for names, status in ((["good"], 0), (["good", "bad"], 1), ([], 1)):
        paths = [f"{name}.npz" for name in names]
        done = subprocess.run([sys.executable, "-I", CHECKER, *paths], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == status
        assert all(f"{path}: " in done.stdout for path in paths)
    assert "bad.npz: rejected: stage 0, frame 0: edges " in done.stdout or not names
