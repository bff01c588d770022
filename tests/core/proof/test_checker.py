"""The checker by itself, and the filter that spares it exact decisions."""

import ast
import subprocess
import sys
from itertools import product
from pathlib import Path

import degenerate_motions
import numpy as np
import pytest
from exact_decisions import meet_triangle
from mobius_flow.core import Curve, Mesh, Task, Trajectory, relax
from mobius_flow.core.driver import RelaxOptions
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import checker
from mobius_flow.core.proof import filter as leg_filter
from shapes import regular_polygon, torus_trefoil
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


def doubtful_pairs(start, end, heads, clearance=0.0):
    """All of them, each by the vertices of its edges; shape (4, pairs)."""
    return np.concatenate([np.empty((4, 0)), *leg_filter.doubtful_pairs(start, end, heads, clearance)], axis=1)


def test_clearance():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    link = np.concatenate([square, square + np.array([0.3, 0.2, 1e-6])])
    heads = Mesh((4, 4)).heads
    assert doubtful_pairs(link, link, heads).size == 0
    assert doubtful_pairs(link, link, heads, clearance=1e-7).size == 0
    assert doubtful_pairs(link, link, heads, clearance=1e-6).size > 0
    wall = square[None, :3] + np.array([0.3, 0.2, -1e-6])
    for clearance in (0.0, 1e-7, 1e-6):
        batches = leg_filter.doubtful_pairs(square, square, Mesh((4,)).heads, clearance, wall)
        assert any(len(batch) == 3 for batch in batches) == (clearance == 1e-6)


def test_an_end_on_an_edge_is_doubtful_whichever_way_is_rounded():
    """Heights above the edge are 0, but for rounding; as many are positive as negative."""
    rng = np.random.default_rng(61)
    for part in rng.integers(1, 16, size=100):
        start = 16.0 * rng.integers(-(2**25), 2**25, size=(4, 3))
        start[0] = start[2] + part / 16 * (start[3] - start[2])
        pairs = doubtful_pairs(start, start, np.array([1, 1, 3, 3]))
        assert [0, 1, 2, 3] in np.sort(pairs, axis=0).T.tolist()


def test_a_step_of_a_knot_needs_no_exact_decision():
    rng, knot = np.random.default_rng(5), torus_trefoil(300)
    end = knot.vertices + 0.01 * rng.normal(size=knot.vertices.shape)
    assert doubtful_pairs(knot.vertices, end, knot.mesh.heads).size == 0


def test_all_pairs_are_looked_at():
    points = np.zeros((30, 3))
    pairs = doubtful_pairs(points, points, Mesh((30,)).heads)
    assert pairs.shape == (4, 30 * 27 // 2)


@pytest.mark.parametrize("seed", range(5))
def test_overlapping_boxes_are_found_exactly_once(seed):
    rng = np.random.default_rng(seed)
    low, others = (rng.integers(0, 9, size=(n, 3)).astype(float) for n in (30, 50))
    first, second = (low, low + rng.integers(0, 3, size=low.shape)), (others, others + rng.integers(0, 3, size=(50, 3)))
    found = [
        pair for i, j in leg_filter.overlapping(first, second) for pair in zip(i.tolist(), j.tolist(), strict=True)
    ]
    meet = (first[0][:, None] <= second[1]).all(axis=2) & (second[0] <= first[1][:, None]).all(axis=2)
    assert len(found) == len(set(found))
    assert set(found) == set(zip(*(k.tolist() for k in np.nonzero(meet)), strict=True))


@pytest.mark.parametrize("n", [3, 16, 40])
def test_filters_lose_no_edge_that_meets_a_triangle(n):
    """All edges against all triangles, exactly, with motions that graze and slide."""
    rng, curve = np.random.default_rng(n), regular_polygon(n)
    start, end = (curve.vertices + rng.integers(-2, 3, size=(n, 3)) for _ in range(2))
    triangles = rng.integers(-2, 3, size=(6, 3, 3)).astype(float)
    found = leg_filter.doubtful_pairs(start, end, curve.mesh.heads, triangles=triangles)
    doubtful = {tuple(pair) for batch in found for pair in batch.T.tolist()}
    for tail, k in product(range(n), range(6)):
        head = int(curve.mesh.heads[tail])
        if meet_triangle(*([*points[[tail, head]], *triangles[k]] for points in (start, end))):
            assert (tail, head, k) in doubtful
