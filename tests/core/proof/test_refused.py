"""Trajectories that claim what is not true, each forged in its own way: all are refused, with the reason."""

import zipfile

import numpy as np
import pytest
from mobius_flow.core.proof import verify
from trajectory_files import Arrays, archive, checked, trajectory

FIRST = np.array([[1.0, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
TRIANGLE = np.array([[9.0, 0, 0], [9.5, 0.75, 0], [8.5, 0.25, 0.75]])
FRAME = np.concatenate([FIRST, FIRST[:, [0, 2, 1]] + [1.0, 0, 0], TRIANGLE])
ARC = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]])
OBSTACLE: Arrays = {"obstacle_000_vertices": np.eye(3) + 20.0, "obstacle_000_faces": np.array([[0, 1, 2]])}


def small():
    """Two linked squares and a triangle that hardly move, on one mesh and on another one with a vertex more."""
    frames = FRAME + 0.125 * np.eye(3)[0] * np.arange(4)[:, None, None]
    finer = np.insert(frames[-1:], 1, frames[-1:, :2].mean(axis=1), axis=1)
    return trajectory(([4, 4, 3], frames), ([5, 4, 3], finer))


def beside_a_multiple_root():
    """Two strands meet in the plane they are in all the time but for heights that vanish just before the start."""
    e, frames = 2.0**-20, []
    shadow = np.array([[-8, -5], [2, 7], [-4, -3], [-4, 4.0]])
    rest = np.array([[23, 34, -6], [17, 1, -13], [-6, -35, -20], [6, 7, -3.0]])
    for heights, t in (([1, 3, -6, -4.0], e), ([-5, -10, 8, 8.0], 1 + e)):
        p = np.column_stack([heights, shadow * t])
        frames.append(np.concatenate([p[:2], rest[:2], p[2:], rest[2:]]))
    return trajectory(([4, 4], frames))


# what is done to the frames of the first stage, and what is said
LEGS = {
    "through": ("frames[2:, 4:8] += [4.0, 0, 0]", "meet", 1),
    "back and forth": ("frames[2, 4:8] += [4.0, 0, 0]", "meet", 1),
    "mirrored": ("frames[2:, :, 2] *= -1; frames[2:, :, :2] += [0.5, 0.25]", "meet", 1),
    "touching": ("frames[3, 4] = frames[3, :2].mean(axis=0)", "meet", 2),
    "doubled vertex": ("frames[:, 5] = frames[:, 4]", "meet", 0),
    "folded neighbours": ("frames[:, 6] = 0.5 * (frames[:, 4] + frames[:, 5])", "meet", 0),
    "reordered": ("frames[2:, :4] = frames[2:, [2, 1, 0, 3]]", "meet", 1),
    "triangle in a line": ("frames[:, 10] = frames[:, 8:10].mean(axis=1)", "a triangle collapses at vertex", 0),
    "triangle in a point": ("frames[:, 8:] = frames[:, 8:9]", "a triangle collapses at vertex", 0),
    "doubled corner": ("frames[1:, 10] = frames[1:, 9]", "a triangle collapses at vertex", 0),
    "triangle turned over": ("frames[2:, 8:] = frames[2:, [9, 8, 10]]", "a triangle collapses at vertex", 1),
    "not finite": ("frames[1, 3, 2] = np.nan", "stage_000, frame 1: a coordinate is not finite", None),
}


@pytest.mark.parametrize("name", LEGS)
def test_legs(tmp_path, name):
    forge, reason, frame = LEGS[name]
    arrays = small()
    exec(forge, {"frames": arrays["stage_000"], "np": np})
    verdict = checked(tmp_path, arrays)
    assert (verdict.accepted, verdict.frame) == (False, frame)
    assert reason in verdict.reason
    if reason == "meet":
        edges = "edges {} and {}".format(*(k + 1 for k in verdict.edges or ()))
        assert str(verdict) == f"rejected: stage 0, frame {frame}: {edges} (counted from 1) meet"


def test_a_multiple_root(tmp_path):
    assert "meet" in checked(tmp_path, beside_a_multiple_root()).reason


# the vertices of another stage, their components' sizes, and what is said
STAGES = {
    "corner cut": (np.delete(FRAME, 1, axis=0), [3, 4, 3], "vertex 1 of the component is not on the edge"),
    "components joined": (FRAME, [4, 7], "another number of components"),
    "components swapped": (FRAME[[4, 5, 6, 7, 0, 1, 2, 3, 8, 9, 10]], [4, 4, 3], "only 0 vertices are kept"),
    "component dropped": (FRAME[:8], [4, 4], "another number of components"),
    "in the plane": (FRAME[:, :2], [4, 4, 3], "another dimension"),
    "reversed": (FRAME[[3, 2, 1, 0, *range(4, 11)]], [4, 4, 3], "not in the same order"),
    "moved": (FRAME + 1e-9, [4, 4, 3], "only 0 vertices are kept"),
    "beside its edge": (np.insert(FRAME, 1, [0, 1, 1e-12], axis=0), [5, 4, 3], "is not on the edge"),
    "out of order": (np.insert(FRAME, [1, 1], [[-0.5, 1, 0], [0.5, 1, 0]], axis=0), [6, 4, 3], "is not on the edge"),
}


@pytest.mark.parametrize("name", STAGES)
def test_changes_of_stage(tmp_path, name):
    vertices, sizes, reason = STAGES[name]
    verdict = checked(tmp_path, trajectory(([4, 4, 3], [FRAME]), (sizes, [vertices])))
    assert (verdict.accepted, verdict.stage, verdict.frame) == (False, 1, None)
    assert reason in verdict.reason


def with_middle(points, edge, shift=0.0):
    return np.insert(points, edge + 1, 0.5 * (points[edge] + points[edge + 1]) + shift, axis=0)


@pytest.mark.parametrize(
    ("other", "reason"),
    [
        (ARC[1:], "an end of an open component is not kept"),
        (ARC[:-1], "an end of an open component is not kept"),
        (ARC[::-1], "an end of an open component is not kept"),
        (np.concatenate([ARC, [[1.0, 1.0, 2.0]]]), "an end of an open component is not kept"),
        (ARC[[0, 2, 1, 3]], "the vertices that are kept are not in the same order"),
        (ARC + 5.0, "only 0 vertices are kept"),
        (with_middle(ARC, 1, shift=1e-9), "vertex 2 of the component is not on the edge between its neighbours"),
        (ARC[[0, 2, 3]], "vertex 1 of the component is not on the edge between its neighbours"),
    ],
)
def test_changes_of_open_components(tmp_path, other, reason):
    finer = with_middle(with_middle(ARC, 2), 0)
    coarser = np.delete(with_middle(finer, 1), 1, axis=0)
    assert checked(tmp_path, trajectory([ARC], [finer], [coarser], opened=True)).accepted
    assert checked(tmp_path, trajectory([ARC], [other], opened=True)).reason == reason


# arrays that are put into the file, or taken out, and what is said
ARRAYS = {
    "stage 3": ({"stage_003": FRAME[None], "component_sizes_003": np.array([4, 4, 3])}, "are not numbered"),
    "no sizes": ({"component_sizes_001": None}, "component_sizes_001 is missing"),
    "an open one": ({"component_closed_001": np.array([True, False, True])}, "closed in one of two stages and open"),
    "too many flags": ({"component_closed_000": np.array([True] * 4)}, "tells of 4 components"),
    "numbers as flags": ({"component_closed_000": np.array([1, 1, 1])}, "of <i8; it must be a list of truth values"),
    "rows of flags": ({"component_closed_000": np.array([[True]])}, "of |b1; it must be a list of truth values"),
    "too small": ({"component_sizes_000": np.array([9, 2])}, "with 2 vertices; a closed polygon has 3 or more"),
    "a point": (
        {"component_sizes_000": np.array([10, 1]), "component_closed_000": np.array([False, False])},
        "with 1 vertices; an open polygon has 2 or more",
    ),
    "objects": ({"stage_000": small()["stage_000"].astype(object)}, "stage_000 is an array"),
    "structures": ({"stage_000": np.zeros((1, 4, 3), dtype=[("x", "<f8")])}, "stage_000 has a header that cannot"),
    "single precision": ({"stage_000": small()["stage_000"].astype(np.float32)}, "of <f4; it must be (k, n, m)"),
    "text": ({"stage_000": small()["stage_000"].astype(str)}, "it must be (k, n, m) of float64"),
    "complex": ({"stage_000": small()["stage_000"].astype(complex)}, "it must be (k, n, m) of float64"),
    "sizes that are objects": ({"component_sizes_000": np.array([4, 4, 3], dtype=object)}, "component_sizes_000 is"),
    "no vertex": ({"obstacle_000_faces": np.array([[0, 1, 3]])}, "obstacle_000_faces: an index has no vertex"),
    "a negative index": ({"obstacle_000_faces": np.array([[0, 1, -1]])}, "obstacle_000_faces: an index has no vertex"),
    "broken indices": ({"obstacle_000_faces": np.array([[0.0, 1.0, 2.0]])}, "must be a table of whole numbers"),
    "quads": ({"obstacle_000_faces": np.array([[0, 1, 2, 2]])}, "it must be (f, 3) or (f, 2)"),
    "no faces": ({"obstacle_000_faces": np.empty((0, 3), dtype=int)}, "is empty; an obstacle has at least one"),
    "a list of faces": ({"obstacle_000_faces": np.array([0, 1, 2])}, "must be a table of whole numbers"),
    "an obstacle nowhere": ({"obstacle_000_vertices": np.eye(3) * np.nan}, "a coordinate is not finite"),
    "a flat obstacle": ({"obstacle_000_vertices": np.eye(3)[:, :2]}, "it must have 3 columns"),
    "a single obstacle": ({"obstacle_000_vertices": np.eye(3, dtype=np.float32)}, "it must be a table of float64"),
    "half an obstacle": ({"obstacle_002_vertices": np.eye(3)}, "the obstacles are not numbered obstacle_000"),
    "obstacle 2": (
        {"obstacle_002_vertices": np.eye(3), "obstacle_002_faces": np.array([[0, 1]])},
        "the obstacles are not numbered",
    ),
    "another name": ({"obstacle_0": np.eye(3)}, "the obstacles are not numbered"),
    "obstacles of a plane curve": (
        {"stage_000": FRAME[None, :, :2], "stage_001": None, "component_sizes_001": None},
        "stage_000 is not in space, as obstacles are",
    ),
    "pins nowhere": ({"pins": np.full((1, 3), np.nan)}, "pins: a coordinate is not finite"),
    "single pins": ({"pins": FRAME[:2].astype(np.float32)}, "pins is an array (2, 3) of <f4"),
    "a list of pins": ({"pins": FRAME[0]}, "pins is an array (3,) of <f8"),
    "whole pins": ({"pins": np.array([[3, 17]])}, "pins is an array (1, 2) of <i8"),
    "flat pins": ({"pins": FRAME[:1, :2]}, "no vertex is at pin 1"),
    "pins of no dimension": ({"pins": FRAME[:1, :0]}, "pins has shape (1, 0); it must have 2 or 3 columns"),
    "pins that are left": ({"pins": FRAME[[0, 4]]}, "vertex 1 leaves pin 1 (counted from 1)"),
}  # fmt: skip


@pytest.mark.parametrize("name", ARRAYS)
def test_arrays(tmp_path, name):
    change, reason = ARRAYS[name]
    arrays = small() | OBSTACLE
    assert checked(tmp_path, arrays).accepted
    changed = {key: array for key, array in (arrays | change).items() if array is not None}
    verdict = checked(tmp_path, changed)
    assert not verdict.accepted
    assert reason in verdict.reason
    assert "\n" not in verdict.reason


@pytest.mark.parametrize(("size", "places"), [(5_000, 3), (9_000, 1)])
def test_many_vertices_in_few_places_are_refused_at_once(tmp_path, size, places):
    assert "meet" in checked(tmp_path, trajectory([np.eye(3)[np.arange(size) % places]])).reason


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", ["component_sizes_000.npy", "stage_000.npy"])
def test_two_arrays_of_one_name(tmp_path, name):
    checked(tmp_path, small())
    with zipfile.ZipFile(tmp_path / "T.npz", "a") as file:
        file.writestr(name, file.read(name))
    assert "two arrays of one name" in verify(tmp_path / "T.npz").reason


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_methods_of_packing_that_numpy_does_not_use(tmp_path, method):
    checked(tmp_path, small())
    with zipfile.ZipFile(tmp_path / "T.npz") as file:
        members = {name: file.read(name) for name in file.namelist()}
    assert "packed by a method" in verify(archive(tmp_path / "P.npz", members, method)).reason
