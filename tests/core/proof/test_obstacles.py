"""Trajectories among obstacles: real ones are accepted, wrong ones refused with the place."""

from itertools import product
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from exact_decisions import meet_triangle
from mobius_flow.core import Obstacle
from mobius_flow.core.proof import Verdict, verify
from mobius_flow.core.proof.filter import doubtful_pairs, overlapping
from shapes import hopf_link, regular_polygon, torus_trefoil
from solids import box, plate, rod, sphere

Array = npt.NDArray[np.float64]


def write(path: Path, frames: list[Array], *obstacles: Obstacle, sizes: tuple[int, ...] = (), **more: object) -> Path:
    arrays: dict[str, object] = {"stage_000": np.stack(frames)}
    arrays["component_sizes_000"] = np.array(sizes or [len(frames[0])])
    for k, obstacle in enumerate(obstacles):
        arrays[f"obstacle_{k:03d}_vertices"] = obstacle.vertices
        arrays[f"obstacle_{k:03d}_faces"] = obstacle.faces
    np.savez(path, **(arrays | more))  # type: ignore[arg-type]
    return path


def rising(steps: int, top: float) -> list[Array]:
    """A trefoil, of heights within ±1, that rises."""
    start = torus_trefoil(60).vertices
    return [start + np.array([0.0, 0.0, top * k / steps]) for k in range(steps + 1)]


@pytest.mark.parametrize("offset", [0.0, 1e4])
def test_accepts_what_stays_clear(tmp_path: Path, offset: float) -> None:
    frames = [frame + offset for frame in rising(5, 0.5)]
    obstacles = [
        Obstacle(each.vertices + offset, each.faces) for each in (plate(2.0), sphere(5.0), rod(0, 0), box(4, 5))
    ]
    verdict = verify(write(tmp_path / "T.npz", frames, *obstacles))
    assert verdict == Verdict(True, 1, 5, obstacles=4)
    assert str(verdict) == "accepted: no contact on 5 legs in 1 stage, nor with 4 obstacles"


@pytest.mark.parametrize("obstacle", [plate(2.0), Obstacle([[-9, 1.0, 2.0], [9, 1.0, 2.0]], [[0, 1]])])
def test_refuses_a_leg_through_an_obstacle(tmp_path: Path, obstacle: Obstacle) -> None:
    """Every frame is clear of it."""
    frames = rising(1, 4.0)
    assert all(verify(write(tmp_path / "F.npz", [frame], obstacle)).accepted for frame in frames)
    verdict = verify(write(tmp_path / "T.npz", [frames[0], frames[0], frames[1]], box(7, 8), obstacle))
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.obstacle) == (False, 0, 1, 1)
    assert verdict.edges is not None
    assert len(verdict.edges) == 1
    assert str(verdict).endswith(f"edge {verdict.edges[0] + 1} meets obstacle 2 (counted from 1)")


def test_refuses_a_start_that_pierces_or_touches(tmp_path: Path) -> None:
    circle = regular_polygon(20).vertices
    for obstacle in (plate(0.0), rod(1.0, 0.0), box(-0.5, 2.0)):
        verdict = verify(write(tmp_path / "T.npz", [circle], obstacle))
        assert (verdict.accepted, verdict.frame, verdict.obstacle) == (False, 0, 0)


def test_refuses_a_link_with_an_obstacle_moved_through_it(tmp_path: Path) -> None:
    link = hopf_link(30)
    frames = [link.vertices, link.vertices + np.array([5.0, 0.0, 0.0])]
    write(tmp_path / "T.npz", frames, rod(3.0, 0.2), sizes=link.mesh.component_sizes)
    verdict = verify(tmp_path / "T.npz")
    assert verdict.obstacle == 0


@pytest.mark.parametrize("between", [True, False])
def test_rounding_of_inserted_vertices_is_checked_for_obstacles(tmp_path: Path, between: bool) -> None:
    """An obstacle is so near that the rounding of an inserted vertex moves the edge through it."""
    unit = np.array([0.0, 2.0**-50, 0.0])
    edge = np.array([[0.0, 0.0, 1.0], [1.0, 0.25, 1.0], [1.0, 0.25, 2.0], [0.0, 0.0, 2.0]])
    middle = 0.5 * (edge[0] + edge[1])
    through = middle + (1 if between else 3) * unit
    needle = Obstacle(through + np.array([[0.0, 0.0, -0.25], [0.0, 0.0, 0.25]]), [[0, 1]])
    bent = np.insert(edge, 1, middle + 2 * unit, axis=0)
    more = {"stage_001": bent[None], "component_sizes_001": np.array([5])}
    assert verify(write(tmp_path / "A.npz", [edge], needle)).accepted
    assert verify(write(tmp_path / "B.npz", [bent], needle)).accepted
    verdict = verify(write(tmp_path / "T.npz", [edge], needle, **more))
    assert verdict.accepted != between
    assert between == ("meets obstacle 1" in verdict.reason)


def test_obstacles_outside_of_all_boxes_are_checked_where_rounding_moves_an_edge(tmp_path: Path) -> None:
    """A vertex above a sloping edge moves down and to the right, out of the boxes of both edges at it."""
    unit = 2.0**-53
    edge = np.array([[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0], [0.0, 0.0, 2.0]])
    bent = np.insert(edge, 1, [0.5, 0.5 + 20 * unit, 1.0], axis=0)
    more = {"stage_001": edge[None], "component_sizes_001": np.array([4])}
    for right, up, between in ((6, 12, True), (12, 6, False)):
        through = np.array([0.5 + right * unit, 0.5 + up * unit, 1.0])
        needle = Obstacle(through + np.array([[0.0, 0.0, -0.25], [0.0, 0.0, 0.25]]), [[0, 1]])
        assert verify(write(tmp_path / "B.npz", [bent], needle)).accepted
        assert verify(write(tmp_path / "T.npz", [bent], needle, **more)).accepted != between


GOOD: dict[str, object] = {"obstacle_000_vertices": np.eye(3) + 9.0, "obstacle_000_faces": np.array([[0, 1, 2]])}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"obstacle_000_faces": np.array([[0, 1, 3]])}, "obstacle_000_faces: an index has no vertex"),
        ({"obstacle_000_faces": np.array([[0, 1, -1]])}, "obstacle_000_faces: an index has no vertex"),
        ({"obstacle_000_faces": np.array([[0.0, 1.0, 2.0]])}, "must be a table of whole numbers"),
        ({"obstacle_000_faces": np.array([[0, 1, 2, 2]])}, r"it must be (f, 3) or (f, 2)"),
        (
            {"obstacle_000_faces": np.empty((0, 3), dtype=int)},
            "obstacle_000_faces is empty; an obstacle has at least one",
        ),
        ({"obstacle_000_faces": np.array([0, 1, 2])}, "must be a table of whole numbers"),
        ({"obstacle_000_vertices": np.eye(3) * np.nan}, "a coordinate is not finite"),
        ({"obstacle_000_vertices": np.eye(3)[:, :2]}, "it must have 3 columns"),
        ({"obstacle_000_vertices": np.eye(3, dtype=np.float32)}, "it must be a table of float64"),
        ({"obstacle_000_vertices": np.eye(3, dtype=object)}, "it must be a table of float64"),
        ({"obstacle_002_vertices": np.eye(3)}, "the obstacles are not numbered obstacle_000"),
        ({"obstacle_002_vertices": np.eye(3), "obstacle_002_faces": np.array([[0, 1]])}, "are not numbered"),
        ({"obstacle_0": np.eye(3)}, "are not numbered"),
        ({"stage_000": regular_polygon(5, 2).vertices[None]}, "stage_000 is not in space, as obstacles are"),
    ],
)
def test_damaged_obstacles_are_refused(tmp_path: Path, change: dict[str, object], said: str) -> None:
    start = regular_polygon(5).vertices
    assert verify(write(tmp_path / "G.npz", [start], **GOOD)).accepted
    verdict = verify(write(tmp_path / "B.npz", [start], **(GOOD | change)))
    assert not verdict.accepted
    assert said in verdict.reason


def test_arrays_in_fortran_order_and_small_integers_are_read(tmp_path: Path) -> None:
    obstacle = plate(0.5)
    arrays = {
        "obstacle_000_vertices": np.asfortranarray(obstacle.vertices),
        "obstacle_000_faces": np.asfortranarray(obstacle.faces.astype(np.uint8)),
    }
    verdict = verify(write(tmp_path / "T.npz", rising(1, 3.0), **arrays))
    assert verdict.obstacle == 0


@pytest.mark.parametrize("seed", range(5))
def test_overlapping_boxes_are_found_exactly_once(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low, others = (rng.integers(0, 9, size=(n, 3)).astype(float) for n in (30, 50))
    first, second = (low, low + rng.integers(0, 3, size=low.shape)), (others, others + rng.integers(0, 3, size=(50, 3)))
    found = [pair for i, j in overlapping(first, second) for pair in zip(i.tolist(), j.tolist(), strict=True)]
    meet = (first[0][:, None] <= second[1]).all(axis=2) & (second[0] <= first[1][:, None]).all(axis=2)
    assert len(found) == len(set(found))
    assert set(found) == set(zip(*(k.tolist() for k in np.nonzero(meet)), strict=True))


@pytest.mark.parametrize("n", [3, 16, 40])
def test_filters_lose_no_edge_that_meets_a_triangle(n: int) -> None:
    """All edges against all triangles, exactly, with motions that graze and slide."""
    rng, curve = np.random.default_rng(n), regular_polygon(n)
    start, end = (curve.vertices + rng.integers(-2, 3, size=(n, 3)) for _ in range(2))
    triangles = rng.integers(-2, 3, size=(6, 3, 3)).astype(float)
    found = doubtful_pairs(start, end, curve.mesh.heads, triangles=triangles)
    doubtful = {tuple(pair) for batch in found for pair in batch.T.tolist()}
    for tail, k in product(range(n), range(6)):
        head = int(curve.mesh.heads[tail])
        if meet_triangle(*([*points[[tail, head]], *triangles[k]] for points in (start, end))):
            assert (tail, head, k) in doubtful
