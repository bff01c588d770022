"""Trajectory files: real ones are accepted, wrong ones refused with the place."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from mobius_flow.core import Curve, Mesh
from mobius_flow.core.collision import free_motion
from mobius_flow.core.proof import Verdict, verify
from shapes import hopf_link, regular_polygon, torus_trefoil

Array = npt.NDArray[np.float64]
Sizes = tuple[int, ...]


def write(path: Path, *stages: tuple[Sizes, list[Array]], compressed: bool = False) -> Path:
    arrays = {}
    for k, (sizes, frames) in enumerate(stages):
        arrays[f"stage_{k:03d}"] = np.stack(frames)
        arrays[f"component_sizes_{k:03d}"] = np.array(sizes)
    (np.savez_compressed if compressed else np.savez)(path, **arrays)
    return path


def walk(curve: Curve, steps: int, seed: int = 3) -> list[Array]:
    """Frames of a random motion that is free of contact."""
    rng, frames = np.random.default_rng(seed), [curve.vertices]
    t = 2 * np.pi * np.arange(len(curve)) / len(curve)
    for _ in range(steps):
        waves = np.stack([np.cos(k * t + rng.uniform(0, 7)) for k in range(6)], axis=1)
        step = 0.3 * waves @ rng.normal(size=(6, curve.dimension))
        share = 0.66 * free_motion(curve.mesh, frames[-1], frames[-1] + step).time
        frames.append(frames[-1] + share * step)
    return frames


def refined(frame: Array, parameters: tuple[float, ...]) -> Array:
    """Every edge cut at the parameters, at rounded points."""
    following = np.roll(frame, -1, axis=0)
    return np.stack([(1 - t) * frame + t * following for t in (0.0, *parameters)], axis=1).reshape(-1, frame.shape[1])


@pytest.mark.parametrize("offset", [0.0, 1e5])
@pytest.mark.parametrize("compressed", [False, True])
def test_accepts_a_free_motion(tmp_path: Path, compressed: bool, offset: float) -> None:
    trefoil = torus_trefoil(60)
    frames = [frame + offset for frame in walk(trefoil, 12)]
    verdict = verify(write(tmp_path / "T.npz", ((60,), frames), compressed=compressed))
    assert verdict == Verdict(True, 1, 12)
    assert str(verdict) == "accepted: no contact on 12 legs in 1 stage"


def test_accepts_links_and_plane_curves(tmp_path: Path) -> None:
    link = hopf_link(30)
    assert verify(write(tmp_path / "L.npz", (link.mesh.component_sizes, walk(link, 6)))).accepted
    plane = regular_polygon(30, dimension=2)
    assert verify(write(tmp_path / "P.npz", ((30,), walk(plane, 6)))).accepted


@pytest.mark.parametrize("frame", [2, 7])
def test_refuses_a_strand_moved_through_another(tmp_path: Path, frame: int) -> None:
    """After the mutation each frame is an embedded curve again; only the leg into it is wrong."""
    link = hopf_link(40)
    frames = walk(link, 10)
    for k in range(frame + 1, len(frames)):
        frames[k] = frames[k].copy()
        frames[k][40:] += [5.0, 0.0, 0.0]
    verdict = verify(write(tmp_path / "T.npz", ((40, 40), frames)))
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.legs) == (False, 0, frame, frame + 1)
    assert verdict.edges is not None
    i, j = sorted(verdict.edges)
    assert i < 40 <= j
    assert str(verdict) == f"rejected: stage 0, frame {frame}: {verdict.reason}"
    assert f"edges {verdict.edges[0] + 1} and {verdict.edges[1] + 1}" in verdict.reason


def test_refuses_a_knot_that_jumps(tmp_path: Path) -> None:
    trefoil = torus_trefoil(60).vertices
    mirror = trefoil * [1, 1, -1]
    for frames in ([trefoil, mirror], [trefoil, 0 * trefoil, mirror], [trefoil, trefoil[::-1]]):
        assert not verify(write(tmp_path / "T.npz", ((60,), frames))).accepted


def test_refuses_a_single_frame_that_touches_itself(tmp_path: Path) -> None:
    eight = np.array([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]])
    verdict = verify(write(tmp_path / "T.npz", ((4,), [eight])))
    assert (verdict.accepted, verdict.edges, verdict.frame) == (False, (0, 2), 0)


def test_a_triangle_may_turn_over_but_not_collapse(tmp_path: Path) -> None:
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]])
    flipped = triangle * [1, -1]
    verdict = verify(write(tmp_path / "T.npz", ((3,), [triangle, flipped])))
    assert not verdict.accepted
    assert "triangle collapses" in verdict.reason
    lifted = [np.concatenate([p, np.zeros((3, 1))], axis=1) for p in (triangle, flipped)]
    assert not verify(write(tmp_path / "S.npz", ((3,), lifted))).accepted
    upright = lifted[0][:, [0, 2, 1]]
    assert verify(write(tmp_path / "S.npz", ((3,), [lifted[0], upright, lifted[1]]))).accepted


@pytest.mark.parametrize("offset", [0.0, 1e4])
def test_accepts_refinement_and_coarsening(tmp_path: Path, offset: float) -> None:
    first = [frame + offset for frame in walk(torus_trefoil(40), 3)]
    fine = refined(first[-1], (0.3, 0.7000001))
    second = walk(Curve(fine - offset), 2)
    second = [fine, *[frame + offset for frame in second[1:]]]
    last = np.roll(second[-1].copy(), 5, axis=0)
    stages = [
        ((40,), first),
        ((120,), second),
        ((120,), [last]),
        ((360,), [refined(last, (0.25, 0.5))]),
        ((120,), [last]),
    ]
    verdict = verify(write(tmp_path / "T.npz", *stages))
    assert verdict.accepted, str(verdict)
    assert (verdict.stages, verdict.legs) == (5, 5)


def test_refinement_of_a_link(tmp_path: Path) -> None:
    link = hopf_link(20)
    parts = [link.vertices[:20], refined(link.vertices[20:], (0.1, 0.4, 0.9))]
    stages = [((20, 20), [link.vertices]), ((20, 80), [np.concatenate(parts)])]
    assert verify(write(tmp_path / "T.npz", *stages)).accepted


def changed(frame: Array, kind: str) -> tuple[Sizes, list[Array]]:
    fine = refined(frame, (0.5,))
    sizes: Sizes = (len(fine),)
    if kind == "off the edge":
        fine[3] += 1e-9
    elif kind == "out of order":
        fine = refined(frame, (0.6, 0.4))
        sizes = (len(fine),)
    elif kind == "moved":
        fine = fine + 1e-12
    elif kind == "reversed":
        fine = fine[::-1]
    elif kind == "another component":
        sizes = (len(fine) // 2, len(fine) // 2)
    elif kind == "other dimension":
        fine = fine[:, :2]
    return sizes, [fine]


KINDS = {
    "off the edge": "not on the edge",
    "out of order": "not on the edge",
    "moved": "only 0 vertices are kept",
    "reversed": "not in the same order",
    "another component": "another number of components",
    "other dimension": "another dimension",
}


@pytest.mark.parametrize("kind", KINDS)
def test_refuses_wrong_transitions(tmp_path: Path, kind: str) -> None:
    frame = torus_trefoil(30).vertices
    verdict = verify(write(tmp_path / "T.npz", ((30,), [frame]), changed(frame, kind)))
    assert not verdict.accepted
    assert (verdict.stage, verdict.frame) == (1, None)
    assert KINDS[kind] in verdict.reason


@pytest.mark.parametrize("between", [True, False])
def test_rounding_of_inserted_vertices_is_checked_for_contact(tmp_path: Path, between: bool) -> None:
    """A strand passes so near that the rounding of an inserted vertex moves the edge through it."""
    unit = np.array([0.0, 2.0**-50, 0.0])
    edge = np.array([[0.0, 0.0, 1.0], [1.0, 0.25, 1.0], [1.0, 0.25, 2.0], [0.0, 0.0, 2.0]])
    inserted = 0.5 * (edge[0] + edge[1]) + 2 * unit
    through = 0.5 * (edge[0] + edge[1]) + (1 if between else 3) * unit
    strand = through + np.array([[0.0, 0.0, -0.25], [0.0, 0.0, 0.25], [0.0, 0.5, 0.0]])
    bent = np.insert(edge, 1, inserted, axis=0)
    stages = ((4, 3), [np.concatenate([edge, strand])]), ((5, 3), [np.concatenate([bent, strand])])
    alone = [verify(write(tmp_path / "one.npz", stage)) for stage in stages]
    assert all(verdict.accepted for verdict in alone)
    verdict = verify(write(tmp_path / "T.npz", *stages))
    assert verdict.accepted != between
    assert between == ("meet" in verdict.reason)


def test_stages_may_end_anywhere(tmp_path: Path) -> None:
    """The same frames in one stage or in several are the same trajectory."""
    frames = walk(torus_trefoil(30), 4)
    sizes = Mesh((30,)).component_sizes
    verdict = verify(write(tmp_path / "T.npz", (sizes, frames[:3]), (sizes, frames[2:])))
    assert (verdict.accepted, verdict.legs) == (True, 4)
    missing = verify(write(tmp_path / "T.npz", (sizes, frames[:2]), (sizes, frames[2:])))
    assert (missing.accepted, missing.stage) == (False, 1)


def bundle(path: Path, strands: int, height: float = 0.0) -> Path:
    """Arcs side by side, all parallel and so near that nothing but whole numbers shows them to be apart."""
    row, column = np.divmod(np.arange(strands), 9)
    tails = np.stack([1.0 + 2.0**-52 * row, 1.0 + 2.0**-52 * column, height * row], axis=1)
    frame = np.stack([tails, tails + np.array([[0.5, 0.25, 0.375]])], axis=1).reshape(-1, 3)
    sizes, closed = np.full(strands, 2), np.zeros(strands, dtype=bool)
    np.savez(path, stage_000=frame[None], component_sizes_000=sizes, component_closed_000=closed)
    return path


def test_more_exact_decisions_than_there_is_time_for_are_refused(tmp_path: Path) -> None:
    assert verify(bundle(tmp_path / "few.npz", 12)).accepted
    verdict = verify(bundle(tmp_path / "many.npz", 80))
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.edges) == (False, 0, 0, None)
    assert "too many edges are so near to each other" in verdict.reason


def test_decisions_about_numbers_of_very_different_size_count_for_more(tmp_path: Path) -> None:
    verdict = verify(bundle(tmp_path / "wide.npz", 12, height=2.0**-1000))
    assert "too many edges are so near to each other" in verdict.reason
