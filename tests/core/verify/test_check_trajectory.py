"""The stand-alone checker: it decides exactly, like ``verify``, but in another way and by whole numbers alone.

That it agrees about whole files is tested wherever a test calls ``verify``: see ``tests/second_opinion.py``.
"""

import ast
import runpy
import subprocess
import sys
from fractions import Fraction

import degenerate_motions
import motions
import numpy as np
import obstacle_motions
import pytest
from mobius_flow.core import Curve, Mesh, Task, Trajectory, relax
from mobius_flow.core.driver import RelaxOptions
from mobius_flow.core.knots import knot
from mobius_flow.core.verify import verify
from mobius_flow.core.verify.segments import meet, meet_triangle
from second_opinion import CHECKER
from solids import box, rod

CHECK = runpy.run_path(str(CHECKER))
COUNT = 25


def whole(*frames):
    """Motions of the points of two frames, in whole numbers."""
    numbers = [x for frame in frames for x in frame.ravel().tolist()]
    unit = max(x.as_integer_ratio()[1] for x in numbers)
    padded = [np.pad(frame, ((0, 0), (0, 3 - frame.shape[1]))).tolist() for frame in frames]
    return list(zip(*([tuple(int(Fraction(x) * unit) for x in p) for p in frame] for frame in padded), strict=True))


def exact(frames):
    return [[[Fraction(x) for x in p] for p in frame.tolist()] for frame in frames]


def edge_motions():
    rng = np.random.default_rng(47)
    for kind in degenerate_motions.KINDS:
        yield from (kind(rng) for _ in range(COUNT))
    for kind in motions.KINDS:
        yield from (kind(rng, dimension) for dimension in (2, 3) for _ in range(COUNT))


def test_it_decides_about_edges_as_verify_does():
    met = 0
    for motion in edge_motions():
        ends = whole(*motion)
        found = CHECK["meet"](*ends)
        assert found == meet(*exact(motion)), motion
        assert not (found and CHECK["apart"](ends[:2], ends[2:])), motion
        met += found
    assert met > 200


@pytest.mark.parametrize("kind", obstacle_motions.KINDS, ids=lambda kind: kind.__name__)
def test_it_decides_about_triangles_as_verify_does(kind):
    rng = np.random.default_rng(49)
    for _ in range(COUNT):
        motion = kind(rng)
        points = whole(*motion)
        found = CHECK["meet_triangle"](*points)
        assert found == meet_triangle(*exact(motion)), motion
        assert not (found and CHECK["apart"](points[:2], points[2:])), motion


def test_it_needs_nothing_but_the_standard_library():
    tree = ast.parse(CHECKER.read_text())
    found = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    found |= {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert found <= sys.stdlib_module_names


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
    trajectory = Trajectory(obstacles=task.obstacles)
    for iterate in relax(task, RelaxOptions(**settings)):
        trajectory.add(iterate)
    arrays = trajectory.arrays()
    last = sum(key.startswith("stage_") for key in arrays) - 1
    backwards = {}
    for key, array in arrays.items():
        kind, _, number = key.rpartition("_")
        turned = array[::-1] if kind == "stage" else array
        backwards[f"{kind}_{last - int(number):03d}" if kind.startswith(("stage", "component")) else key] = turned
    for each in (arrays, backwards):
        np.savez_compressed(tmp_path / "T.npz", **each)
        verdict = verify(tmp_path / "T.npz")  # and the checker, see above
        assert verdict.accepted, str(verdict)


def test_crossings_that_were_tuned_to_be_overlooked_are_refused(tmp_path):
    rng = np.random.default_rng(51)
    arcs = degenerate_motions.ARCS
    for _ in range(5):
        frames = np.stack(degenerate_motions.tied_windows(rng))
        mesh = Mesh((2,) * arcs, closed=(False,) * arcs)
        arrays = {"component_sizes_000": np.array(mesh.component_sizes), "component_closed_000": np.array(mesh.closed)}
        np.savez(tmp_path / "T.npz", stage_000=frames, **arrays)
        assert not verify(tmp_path / "T.npz").accepted


def test_the_command_says_which_and_why(tmp_path):
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    np.savez(tmp_path / "good.npz", stage_000=np.stack([square, 2 * square]), component_sizes_000=[4])
    np.savez(tmp_path / "bad.npz", stage_000=np.stack([square, -square]), component_sizes_000=[4])
    for names, status in ((["good"], 0), (["good", "bad"], 1), ([], 1)):
        paths = [f"{name}.npz" for name in names]
        done = subprocess.run([sys.executable, "-I", CHECKER, *paths], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == status
        assert all(f"{path}: " in done.stdout for path in paths)
    assert "bad.npz: rejected: stage 0, frame 0: the edges at vertices" in done.stdout or not names
