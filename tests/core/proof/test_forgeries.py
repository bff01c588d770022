"""Trajectories that claim what is not true, each forged in its own way from a good one: all are refused."""

import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import RelaxOptions, Trajectory, relax
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify

Arrays = dict[str, np.ndarray]


@cache
def genuine() -> Arrays:
    """A knot on a mesh that changes."""
    trajectory = Trajectory()
    for iterate in relax(knot("4_1"), RelaxOptions(max_iterations=14, mesh="adaptive", vertices=75)):
        trajectory.add(iterate)
    arrays = trajectory.arrays()
    return {name: np.array(array) for name, array in arrays.items() if name.startswith(("stage", "component"))}


def small() -> Arrays:
    """Two linked squares and a triangle that hardly move."""
    first = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    second = first[:, [0, 2, 1]] + [1.0, 0, 0]
    triangle = np.array([[9.0, 0, 0], [9.5, 0.75, 0], [8.5, 0.25, 0.75]])
    frame = np.concatenate([first, second, triangle])
    frames = frame + 0.125 * np.eye(3)[0] * np.arange(4)[:, None, None]
    return {"stage_000": frames, "component_sizes_000": np.array([4, 4, 3])}


def through(arrays: Arrays) -> None:
    arrays["stage_000"][2:, 4:8] += [4.0, 0, 0]


def jumps_back_and_forth(arrays: Arrays) -> None:
    arrays["stage_000"][2, 4:8] += [4.0, 0, 0]


def mirrored(arrays: Arrays) -> None:
    arrays["stage_000"][2:, :, 2] *= -1
    arrays["stage_000"][2:, :, :2] += [0.5, 0.25]


def touching(arrays: Arrays) -> None:
    arrays["stage_000"][3, 4] = arrays["stage_000"][3, :2].mean(axis=0)


def doubled_vertex(arrays: Arrays) -> None:
    arrays["stage_000"][:, 5] = arrays["stage_000"][:, 4]


def folded_neighbours(arrays: Arrays) -> None:
    frames = arrays["stage_000"]
    frames[:, 6] = 0.5 * (frames[:, 4] + frames[:, 5])


def triangle_in_a_line(arrays: Arrays) -> None:
    arrays["stage_000"][:, 10] = arrays["stage_000"][:, 8:10].mean(axis=1)


def triangle_in_a_point(arrays: Arrays) -> None:
    arrays["stage_000"][:, 8:] = arrays["stage_000"][:, 8:9]


def triangle_with_a_doubled_vertex(arrays: Arrays) -> None:
    arrays["stage_000"][1:, 10] = arrays["stage_000"][1:, 9]


def vertices_reordered(arrays: Arrays) -> None:
    arrays["stage_000"][2:, :4] = arrays["stage_000"][2:, [2, 1, 0, 3]]


def next_stage(arrays: Arrays) -> np.ndarray:
    arrays["component_sizes_001"] = arrays["component_sizes_000"]
    arrays["stage_001"] = arrays["stage_000"][-1:].copy()
    return arrays["stage_001"]


def corner_cut(arrays: Arrays) -> None:
    frames = np.delete(next_stage(arrays), 1, axis=1)
    arrays["stage_001"], arrays["component_sizes_001"] = frames, np.array([3, 4, 3])


def components_joined(arrays: Arrays) -> None:
    next_stage(arrays)
    arrays["component_sizes_001"] = np.array([4, 7])


def stage_moved(arrays: Arrays) -> None:
    next_stage(arrays)[:] += 1e-9


def components_swapped(arrays: Arrays) -> None:
    frames = next_stage(arrays)
    arrays["stage_001"] = frames[:, [4, 5, 6, 7, 0, 1, 2, 3, 8, 9, 10]]


def component_dropped(arrays: Arrays) -> None:
    arrays["stage_001"], arrays["component_sizes_001"] = next_stage(arrays)[:, :8], np.array([4, 4])


def vertex_beside_its_edge(arrays: Arrays) -> None:
    frames = next_stage(arrays)
    inserted = frames[:, :2].mean(axis=1) + 1e-12 * np.eye(3)[2]
    arrays["stage_001"], arrays["component_sizes_001"] = np.insert(frames, 1, inserted, axis=1), np.array([5, 4, 3])


def not_finite(arrays: Arrays) -> None:
    arrays["stage_000"][1, 3, 2] = np.nan


def stage_left_out(arrays: Arrays) -> None:
    next_stage(arrays)
    arrays["stage_002"], arrays["component_sizes_002"] = arrays.pop("stage_001"), arrays.pop("component_sizes_001")


def beside_a_multiple_root(arrays: Arrays) -> None:
    """Two strands meet in the plane they are in all the time but for heights that vanish just before the start."""
    e = 2.0**-20
    shadow = np.array([[-8, -5], [2, 7], [-4, -3], [-4, 4.0]])
    rest = np.array([[23, 34, -6], [17, 1, -13], [-6, -35, -20], [6, 7, -3.0]])
    frames = []
    for heights, t in (([1, 3, -6, -4.0], e), ([-5, -10, 8, 8.0], 1 + e)):
        p = np.column_stack([heights, shadow * t])
        frames.append(np.concatenate([p[:2], rest[:2], p[2:], rest[2:]]))
    arrays["stage_000"], arrays["component_sizes_000"] = np.stack(frames), np.array([4, 4])


FORGERIES: tuple[Callable[[Arrays], None], ...] = (
    through,
    jumps_back_and_forth,
    mirrored,
    touching,
    doubled_vertex,
    folded_neighbours,
    triangle_in_a_line,
    triangle_in_a_point,
    triangle_with_a_doubled_vertex,
    components_joined,
    vertices_reordered,
    corner_cut,
    stage_moved,
    components_swapped,
    component_dropped,
    vertex_beside_its_edge,
    not_finite,
    stage_left_out,
    beside_a_multiple_root,
)


def saved(path: Path, arrays: Arrays) -> Path:
    np.savez(path, **arrays)
    return path


def test_genuine_ones_are_accepted(tmp_path: Path) -> None:
    verdict = verify(saved(tmp_path / "small.npz", small()))
    assert verdict.accepted, str(verdict)
    verdict = verify(saved(tmp_path / "run.npz", genuine()))
    assert verdict.accepted, str(verdict)
    assert verdict.stages > 1
    arrays = small()
    next_stage(arrays)
    assert verify(saved(tmp_path / "stages.npz", arrays)).accepted


@pytest.mark.parametrize("forge", FORGERIES, ids=lambda forge: forge.__name__)
def test_forgeries_are_refused(tmp_path: Path, forge: Callable[[Arrays], None]) -> None:
    arrays = small()
    forge(arrays)
    verdict = verify(saved(tmp_path / "T.npz", arrays))
    assert not verdict.accepted
    assert verdict.reason


@pytest.mark.parametrize("size", [5_000, 9_000])
@pytest.mark.parametrize("places", [1, 3])
def test_many_vertices_in_few_places_are_refused_at_once(tmp_path: Path, size: int, places: int) -> None:
    frame = np.eye(3)[np.arange(size) % places]
    verdict = verify(saved(tmp_path / "T.npz", {"stage_000": frame[None], "component_sizes_000": np.array([size])}))
    assert not verdict.accepted
    assert "meet" in verdict.reason


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", ["component_sizes_000.npy", "stage_000.npy"])
def test_two_arrays_of_one_name(tmp_path: Path, name: str) -> None:
    path = saved(tmp_path / "T.npz", small())
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr(name, archive.read(name))
    assert not verify(path).accepted


def test_more_sizes_than_announced(tmp_path: Path) -> None:
    good, path = saved(tmp_path / "good.npz", small()), tmp_path / "T.npz"
    with zipfile.ZipFile(good) as source, zipfile.ZipFile(path, "w") as archive:
        for name in source.namelist():
            archive.writestr(name, source.read(name) + (b"more" if name.startswith("component") else b""))
    assert "longer than its header says" in verify(path).reason


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_methods_of_packing_that_numpy_does_not_use(tmp_path: Path, method: int) -> None:
    good, path = saved(tmp_path / "good.npz", small()), tmp_path / "T.npz"
    with zipfile.ZipFile(good) as source, zipfile.ZipFile(path, "w", method) as archive:
        for name in source.namelist():
            archive.writestr(name, source.read(name))
    assert "packed by a method" in verify(path).reason


def test_progress_counts_the_legs_of_all_stages(tmp_path: Path) -> None:
    arrays = small()
    next_stage(arrays)
    arrays["stage_001"] = np.concatenate([arrays["stage_001"]] * 3)
    told: list[tuple[int, int]] = []
    path = saved(tmp_path / "T.npz", arrays)
    assert verify(path, lambda done, legs: told.append((done, legs))) == verify(path)
    assert told == [(k, 5) for k in range(1, 6)]
