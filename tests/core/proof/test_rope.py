"""Trajectories of ropes: what is one is accepted, and each way of not being one is told, by both doors."""

import os
from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import Iterate, Mesh, Obstacle, RelaxOptions, Trajectory, minimize
from mobius_flow.core.collision import is_rope
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import checker, verify
from mobius_flow.core.proof.filter import FloatingSieve
from shapes import regular_polygon

COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "20"))


@pytest.fixture(scope="module")
def run():
    """A short relaxation of a figure-eight knot with few vertices."""
    trajectory = Trajectory()
    options = RelaxOptions(radius="keep", max_iterations=6, vertices=40, mesh="fixed")
    minimize(knot("4_1", 40), options, callback=trajectory.add)
    return {name: np.asarray(array) for name, array in trajectory.arrays().items()}


def verdicts(path, arrays):
    np.savez(path / "rope.npz", **arrays)
    return verify(path / "rope.npz"), checker.check(path / "rope.npz")


def test_a_run_is_accepted(tmp_path, run):
    for verdict in verdicts(tmp_path, run):
        assert verdict.accepted
        assert verdict.radius == tuple(run["radius"])
        assert "a rope of radius" in str(verdict)


def test_files_without_a_radius_say_nothing_of_ropes(tmp_path, run):
    for verdict in verdicts(tmp_path, {name: array for name, array in run.items() if name != "radius"}):
        assert verdict.accepted
        assert "rope" not in str(verdict)


@pytest.mark.parametrize("factor", [1.4, 2.0, 50.0, 1e6])
def test_no_rope_is_thicker_than_it_is(tmp_path, run, factor):
    one, other = verdicts(tmp_path, run | {"radius": factor * run["radius"]})
    assert not one.accepted
    assert not other.accepted
    assert (one.stage, one.frame) == (other.stage, other.frame)


@pytest.mark.parametrize(
    ("radius", "reason"),
    [
        ([], "a number above 0"),
        ([0.0], "a number above 0"),
        ([-0.1], "a number above 0"),
        ([np.nan], "not finite"),
        ([0.1, 0.1], "has 2 numbers, but stage_000 has 1 components"),
        ([[0.1]], "it must be a list of float64"),
        ([1], "it must be a list of float64"),
    ],
)
def test_radii_that_are_none(tmp_path, run, radius, reason):
    for verdict in verdicts(tmp_path, run | {"radius": np.array(radius)}):
        assert not verdict.accepted
        assert reason in verdict.reason


def moved(run, seed):
    """A vertex of some frame is elsewhere: a forgery, unless it is a rope all the same."""
    rng, stage = np.random.default_rng(seed), run["stage_000"].copy()
    frame, vertex = rng.integers(1, len(stage)), rng.integers(stage.shape[1])
    stage[frame, vertex] += rng.standard_normal(3) * run["radius"] * rng.choice([0.5, 2.0, 5.0])
    return run | {"stage_000": stage}


def crowded(start, end, radius):
    """Whether at some of the times on a leg two points more than a whole circle apart along it are too near."""
    for t in np.linspace(0.0, 1.0, 9):
        p = (1 - t) * start + t * end
        points = np.concatenate([(1 - s) * p + s * np.roll(p, -1, axis=0) for s in (0.0, 0.25, 0.5, 0.75)])
        points = points.reshape(4, -1, 3).swapaxes(0, 1).reshape(-1, 3)
        arc = np.cumsum(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1))
        along = np.abs(arc[:, None] - arc)
        far = np.minimum(along, arc[-1] - along) > 2 * np.pi * radius
        if (np.linalg.norm(points[:, None] - points, axis=2)[far] < 2 * radius).any():
            return True
    return False


def test_forged_vertices(tmp_path, run):
    """Of some forgeries none on whose way strands are too near is accepted, and all that the program proves are."""
    mesh, radius, refused = Mesh(tuple(run["component_sizes_000"].tolist())), run["radius"], 0
    for seed in range(COUNT):
        forged = moved(run, seed)
        legs = list(zip(forged["stage_000"], forged["stage_000"][1:], strict=False))
        np.savez(tmp_path / "forged.npz", **forged)
        accepted = checker.check(tmp_path / "forged.npz", FloatingSieve).accepted
        if any(crowded(a, b, radius[0]) for a, b in legs):
            assert not accepted
            refused += 1
        elif all(is_rope(mesh, a, b, 1.001 * radius) for a, b in legs):
            assert accepted
    assert refused > COUNT / 10


def test_the_plain_checker_agrees_about_forgeries(tmp_path, run):
    answers = [[verdict.accepted for verdict in verdicts(tmp_path, moved(run, seed))] for seed in range(6)]
    assert all(one == other for one, other in answers)
    assert {one for one, _ in answers} == {True, False} or not any(one for one, _ in answers)


@pytest.mark.parametrize(
    ("shape", "closed", "limit"),
    [
        ([[0, 0.1], [0, -0.1], [5, 0]], True, 0.2 * 5.0 / (0.2 + 2.0 * np.hypot(5.0, 0.1))),  # inscribed circle
        ([[5, 0.05], [0, 0.1], [0, -0.1], [5, -0.05]], False, 0.05),  # half of what is between the ends
    ],
)
def test_strands_next_to_a_corner_are_those_of_the_rope_that_fits(tmp_path, shape, closed, limit):
    """However sharp it is; those after the next are looked at."""
    arrays = {"stage_000": np.array([shape], dtype=float), "component_sizes_000": np.array([len(shape)])}
    arrays["component_closed_000"] = np.array([closed])
    for share, fits in ((0.99, True), (1.01, False)):
        found = verdicts(tmp_path, arrays | {"radius": np.array([share * limit])})
        assert [verdict.accepted for verdict in found] == [fits, fits]


def test_obstacles_are_as_far_as_the_radius(tmp_path):
    wall = Obstacle([[-5.0, -5, 0], [5, -5, 0], [0, 9, 0]], [[0, 1, 2]])
    strand = np.array([[0.0, 0, 1], [1, 0, 1]])
    arrays = {
        "stage_000": np.stack([strand, strand - [0, 0, 0.5]]),
        "component_sizes_000": np.array([2]),
        "component_closed_000": np.array([False]),
        "obstacle_000_vertices": wall.vertices,
        "obstacle_000_faces": wall.faces,
    }
    for radius, accepted in ((0.49, True), (0.51, False)):
        for verdict in verdicts(tmp_path, arrays | {"radius": np.array([radius])}):
            assert verdict.accepted is accepted
            assert accepted or verdict.obstacle == 0


def test_a_corner_gets_too_sharp(tmp_path):
    arrays = {
        "stage_000": np.array([[[1.0, 0, 0], [0, 0, 0], [0, 1.0, 0]], [[1.0, 0, 0], [0, 0, 0], [0.4, 0.9, 0]]]),
        "component_sizes_000": np.array([3]),
        "component_closed_000": np.array([False]),
    }
    for radius, accepted in ((0.2, True), (0.8, False)):
        for verdict in verdicts(tmp_path, arrays | {"radius": np.array([radius])}):
            assert verdict.accepted is accepted
            assert accepted or "bends too sharply" in verdict.reason


def test_edges_that_count_in_part(tmp_path):
    """A hairpin whose legs close in on each other: near the bend they do not count, at their ends they do."""
    hairpin = np.array([[[10.0, 0, 0], [0, 0, 0], [0, 1, 0], [10, 0.5, 0]]])
    arrays = {"stage_000": hairpin, "component_sizes_000": np.array([4]), "component_closed_000": np.array([False])}
    for radius, accepted in ((0.2, True), (0.4, False)):
        assert is_rope(Mesh((4,), (False,)), hairpin[0], hairpin[0], np.array([radius])) is accepted
        for verdict in verdicts(tmp_path, arrays | {"radius": np.array([radius])}):
            assert verdict.accepted is accepted
            assert accepted or verdict.edges == (0, 2)


def test_a_file_has_the_least_radius_of_its_run():
    trajectory, iterates = Trajectory(), list[Iterate]()
    minimize(knot("3_1", 30), RelaxOptions(radius="keep", max_iterations=2), callback=iterates.append)
    for share, iterate in zip((1.0, 0.5, 0.8), iterates, strict=False):
        trajectory.add(replace(iterate, radius=(share,)))
    assert trajectory.arrays()["radius"].tolist() == [0.5]


@pytest.mark.parametrize("margin", [1e-3, 1e-4, 3.5e-5])
def test_the_checker_bounds_corners_as_finely_as_runs_do(margin):
    """Of a corner whose edge shrinks while the angle does, bounds over a part of the time are loose."""
    start, end = np.array([[-1.0, 0, 0], [0, 0, 0], [0, 2, 0]]), np.array([[-1.0, 0, 0], [0, 0, 0], [0.01, 1, 0]])
    assert is_rope(Mesh((3,), (False,)), start, end, np.array([1.0 - margin]))
    size = 10**30
    edge, shrinking = ((size, 0, 0),) * 2, ((0, 2 * size, 0), (size // 100, size, 0))
    assert checker.arcs_fit(edge, [shrinking], int(size * (1.0 - margin)))
    assert not checker.arcs_fit(edge, [shrinking], int(size * (1.0 + margin)))


@pytest.mark.parametrize("first", [7, 19])
def test_strands_of_closed_components_count(tmp_path, first):
    """Wherever the numbers of vertices begin: rings that come nearer than two radii, and those that do not."""
    ring = regular_polygon(24).vertices
    rings = [np.roll(ring, first, axis=0), ring[:, [0, 2, 1]] + [1.0, 0.01, 0.02]]
    near, far = (np.concatenate([rings[0], rings[1] + [shift, 0.0, 0.0]]) for shift in (0.25, 0.1))
    for ends, accepted in (((near, far), False), ((far, far), True)):
        arrays = {"stage_000": np.stack(ends), "component_sizes_000": np.array([24, 24]), "radius": np.full(2, 0.4)}
        assert [each.accepted for each in verdicts(tmp_path, arrays)] == [accepted] * 2
