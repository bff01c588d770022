"""Trajectories with open components: what their files say, and what may change from stage to stage."""

from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core.proof import Verdict, verify

ARC = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]])


def checked(tmp_path: Path, *stages: np.ndarray, **arrays: object) -> Verdict:
    named = {f"stage_{k:03d}": points[None] for k, points in enumerate(stages)}
    named |= {f"component_sizes_{k:03d}": np.array([len(points)]) for k, points in enumerate(stages)}
    named |= {f"component_closed_{k:03d}": np.array([False]) for k in range(len(stages))}
    np.savez(tmp_path / "t.npz", **{name: array for name, array in (named | arrays).items() if array is not None})
    return verify(tmp_path / "t.npz")


def with_middle(points: np.ndarray, edge: int, shift: float = 0.0) -> np.ndarray:
    return np.insert(points, edge + 1, 0.5 * (points[edge] + points[edge + 1]) + shift, axis=0)


def test_vertices_on_edges_may_come_and_go(tmp_path: Path) -> None:
    finer = with_middle(with_middle(ARC, 2), 0)
    assert checked(tmp_path, ARC, finer, ARC).accepted
    assert checked(tmp_path, ARC, np.delete(with_middle(finer, 1), 1, axis=0)).accepted


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
def test_other_curves_are_rejected(tmp_path: Path, other: np.ndarray, reason: str) -> None:
    verdict = checked(tmp_path, ARC, other)
    assert not verdict.accepted
    assert verdict.reason == reason


def test_components_stay_open_or_closed(tmp_path: Path) -> None:
    verdict = checked(tmp_path, ARC, ARC, component_closed_001=None)
    assert verdict.reason == "a component is closed in one of two stages and open in the other"


@pytest.mark.parametrize(
    ("flags", "reason"),
    [
        ([False, True], "component_closed_000 tells of 2 components, component_sizes_000 of 1"),
        ([0], "component_closed_000 is an array (1,) of <i8; it must be a list of truth values"),
        ([[False]], "component_closed_000 is an array (1, 1) of |b1; it must be a list of truth values"),
    ],
)
def test_flags_that_say_nothing(tmp_path: Path, flags: list[object], reason: str) -> None:
    assert checked(tmp_path, ARC, component_closed_000=np.array(flags)).reason == reason


@pytest.mark.parametrize(
    ("size", "flag", "least"), [(1, False, "an open polygon has 2"), (2, True, "a closed polygon has 3")]
)
def test_too_few_vertices(tmp_path: Path, size: int, flag: bool, least: str) -> None:
    verdict = checked(tmp_path, ARC[:size], component_closed_000=np.array([flag]))
    assert verdict.reason.startswith(f"component_sizes_000 has a component with {size} vertices; {least} or more")
