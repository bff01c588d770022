"""Pins of a trajectory: real ones are counted, those that a vertex leaves or never held are refused with the place."""

from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import RelaxOptions, Trajectory, relax
from mobius_flow.core.proof import Verdict, verify
from shapes import torus_trefoil
from tasks import wanted

START = torus_trefoil(40)
PINS = START.vertices[[3, 17]]


def saved(path: Path, **arrays: np.ndarray) -> Verdict:
    np.savez(path / "T.npz", **arrays)  # type: ignore[arg-type]
    return verify(path / "T.npz")


def moved(*vertices: int) -> dict[str, np.ndarray]:
    """A trefoil of which some vertices move in the second of two legs, by a unit in the last place."""
    frames = np.stack([START.vertices] * 3)
    frames[2, vertices, 0] = np.nextafter(frames[2, vertices, 0], np.inf)
    return {"stage_000": frames, "component_sizes_000": np.array([40])}


@pytest.mark.parametrize("mesh", ["fixed", "adaptive"])
def test_a_run_writes_its_pins_and_they_hold_on_every_mesh(tmp_path: Path, mesh: str) -> None:
    trajectory = Trajectory()
    for iterate in relax(*wanted(START, pins=(3, 17), pin_tangents=True, mesh=mesh, max_iterations=12)):
        trajectory.add(iterate)
    assert len(trajectory.arrays()["pins"]) == 6
    verdict = saved(tmp_path, **trajectory.arrays())  # type: ignore[arg-type]
    assert verdict.accepted
    assert str(verdict).endswith("; 6 pins in place")


def test_what_has_no_pins_says_nothing_of_them(tmp_path: Path) -> None:
    trajectory = Trajectory()
    for iterate in relax(START, RelaxOptions(max_iterations=2)):
        trajectory.add(iterate)
    assert "pins" not in trajectory.arrays()
    assert saved(tmp_path, **moved(3)) == Verdict(True, 1, 2)


def test_a_pinned_vertex_that_moves_is_named(tmp_path: Path) -> None:
    assert saved(tmp_path, **moved(4, 16), pins=PINS).accepted
    verdict = saved(tmp_path, **moved(4, 17), pins=PINS)
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.pins) == (False, 0, 1, 2)
    assert verdict.reason == "vertex 18 leaves pin 2 (counted from 1)"


def test_each_stage_has_a_vertex_at_each_pin(tmp_path: Path) -> None:
    """Vertex 17 is left out where it lies on an edge: the same curve, but nothing holds it any more."""
    frames = np.stack([np.insert(START.vertices, 17, START.vertices[[16, 17]].mean(axis=0), axis=0)])
    stages = {"stage_000": frames, "component_sizes_000": np.array([41])} | {
        "stage_001": START.vertices[None],
        "component_sizes_001": np.array([40]),
    }
    assert saved(tmp_path, **stages, pins=frames[0, [3, 18]]).accepted
    verdict = saved(tmp_path, **stages, pins=frames[0, [3, 17]])
    assert (verdict.accepted, verdict.stage) == (False, 1)
    assert verdict.reason == "no vertex is at pin 2 (counted from 1)"


@pytest.mark.parametrize(
    ("pins", "said"),
    [
        (PINS * np.nan, "pins: a coordinate is not finite"),
        (PINS.astype(np.float32), "pins is an array (2, 3) of <f4"),
        (PINS[0], "pins is an array (3,) of <f8"),
        (PINS[:, :2], "no vertex is at pin 1"),
        (PINS[:, :0], "pins has shape (2, 0); it must have 2 or 3 columns"),
        (np.array([[3, 17]]), "pins is an array (1, 2) of <i8"),
    ],
)
def test_damaged_pins_are_refused(tmp_path: Path, pins: np.ndarray, said: str) -> None:
    verdict = saved(tmp_path, **moved(), pins=pins)
    assert not verdict.accepted
    assert said in verdict.reason
