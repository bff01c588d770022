"""Legs, stages, obstacles and pins of trajectories: what is true is accepted, what is not is refused with the place."""

import numpy as np
import pytest
from mobius_flow.core import Curve, Obstacle, RelaxOptions, Trajectory, relax
from mobius_flow.core.collision import free_motion
from mobius_flow.core.proof import Verdict, verify
from shapes import hopf_link, regular_polygon, torus_trefoil
from solids import box, plate, rod, sphere
from tasks import wanted
from trajectory_files import checked, trajectory

PINNED = torus_trefoil(40)


def walk(curve, steps, seed=3):
    """Frames of a random motion that is free of contact."""
    rng, frames = np.random.default_rng(seed), [curve.vertices]
    t = 2 * np.pi * np.arange(len(curve)) / len(curve)
    for _ in range(steps):
        waves = np.stack([np.cos(k * t + rng.uniform(0, 7)) for k in range(6)], axis=1)
        step = 0.3 * waves @ rng.normal(size=(6, curve.dimension))
        share = 0.66 * free_motion(curve.mesh, frames[-1], frames[-1] + step).time
        frames.append(frames[-1] + share * step)
    return frames


def refined(frame, *parameters):
    """Every edge cut at the parameters, at rounded points."""
    following = np.roll(frame, -1, axis=0)
    return np.stack([(1 - t) * frame + t * following for t in (0.0, *parameters)], axis=1).reshape(-1, frame.shape[1])


def rising(steps, top):
    """A trefoil, of heights within ±1, that rises."""
    return [torus_trefoil(60).vertices + np.array([0.0, 0.0, top * k / steps]) for k in range(steps + 1)]


@pytest.mark.parametrize("offset", [0.0, 1e5])
@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_free_motions(tmp_path, save, offset):
    verdict = checked(tmp_path, trajectory([frame + offset for frame in walk(torus_trefoil(60), 12)]), save)
    assert verdict == Verdict(True, 1, 12)
    assert str(verdict) == "accepted: no contact on 12 legs in 1 stage"


def test_links_and_plane_curves(tmp_path):
    assert checked(tmp_path, trajectory(([30, 30], walk(hopf_link(30), 6)))).accepted
    assert checked(tmp_path, trajectory(walk(regular_polygon(30, dimension=2), 6))).accepted


def test_a_single_frame_that_touches_itself(tmp_path):
    verdict = checked(tmp_path, trajectory([np.array([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]])]))
    assert (verdict.accepted, verdict.edges, verdict.frame) == (False, (0, 2), 0)


def test_a_triangle_may_turn_over_in_space(tmp_path):
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]])
    flat, turned = (np.column_stack([triangle * [1, sign], np.zeros(3)]) for sign in (1, -1))
    assert checked(tmp_path, trajectory([flat, flat[:, [0, 2, 1]], turned])).accepted
    for frames in ([flat, turned], [triangle, triangle * [1, -1]]):
        assert "a triangle collapses at vertex" in checked(tmp_path, trajectory(frames)).reason


@pytest.mark.parametrize("offset", [0.0, 1e4])
def test_refinement_and_coarsening(tmp_path, offset):
    first = walk(torus_trefoil(40), 3)
    fine = refined(first[-1] + offset, 0.3, 0.7000001)
    second = [fine, *(frame + offset for frame in walk(Curve(fine - offset), 2)[1:])]
    last = np.roll(second[-1], 5, axis=0)
    stages = [frame + offset for frame in first], second, [last], [refined(last, 0.25, 0.5)], [last]
    verdict = checked(tmp_path, trajectory(*stages))
    assert verdict.accepted, str(verdict)
    assert (verdict.stages, verdict.legs) == (5, 5)


def test_refinement_of_one_component(tmp_path):
    one, other = hopf_link(20).vertices.reshape(2, 20, 3)
    finer = np.concatenate([one, refined(other, 0.1, 0.4, 0.9)])
    assert checked(tmp_path, trajectory(([20, 20], [hopf_link(20).vertices]), ([20, 80], [finer]))).accepted


def test_stages_may_end_anywhere(tmp_path):
    frames = walk(torus_trefoil(30), 4)
    told = []
    verdict = checked(tmp_path, trajectory(frames[:3], frames[2:]))
    assert (verdict.accepted, verdict.legs) == (True, 4)
    assert verify(tmp_path / "T.npz", lambda done, legs: told.append((done, legs))) == verdict
    assert told == [(k, 4) for k in range(1, 5)]
    missing = checked(tmp_path, trajectory(frames[:2], frames[2:]))
    assert (missing.accepted, missing.stage) == (False, 1)


@pytest.mark.parametrize("between", [True, False])
@pytest.mark.parametrize("still", [True, False])
def test_rounding_of_inserted_vertices_is_checked(tmp_path, between, still):
    """A strand, or an obstacle, is so near that the rounding of an inserted vertex moves the edge through it."""
    unit = np.array([0.0, 2.0**-50, 0.0])
    edge = np.array([[0.0, 0.0, 1.0], [1.0, 0.25, 1.0], [1.0, 0.25, 2.0], [0.0, 0.0, 2.0]])
    middle = 0.5 * (edge[0] + edge[1])
    bent = np.insert(edge, 1, middle + 2 * unit, axis=0)
    strand = middle + (1 if between else 3) * unit + np.array([[0.0, 0.0, -0.25], [0.0, 0.0, 0.25], [0.0, 0.5, 0.0]])
    parts = [[edge], [bent]]
    if not still:
        parts = [([len(part), 3], [np.concatenate([part, strand])]) for part in (edge, bent)]
    obstacles = [Obstacle(strand[:2], [[0, 1]])] if still else []
    for part in parts:
        assert checked(tmp_path, trajectory(part, obstacles=obstacles)).accepted
    verdict = checked(tmp_path, trajectory(*parts, obstacles=obstacles))
    assert verdict.accepted != between
    assert between == (("meets obstacle 1" if still else "meet") in verdict.reason)


def bundle(strands, height=0.0):
    """Arcs side by side, all parallel and so near that nothing but whole numbers shows them to be apart."""
    row, column = np.divmod(np.arange(strands), 9)
    tails = np.stack([1.0 + 2.0**-52 * row, 1.0 + 2.0**-52 * column, height * row], axis=1)
    frame = np.stack([tails, tails + np.array([[0.5, 0.25, 0.375]])], axis=1).reshape(-1, 3)
    return trajectory(([2] * strands, [frame]), opened=True)


def test_more_exact_decisions_than_there_is_time_for_are_refused(tmp_path):
    assert checked(tmp_path, bundle(12)).accepted
    verdict = checked(tmp_path, bundle(80))
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.edges) == (False, 0, 0, None)
    assert "too many edges are so near to each other" in verdict.reason


def test_decisions_about_numbers_of_very_different_size_count_for_more(tmp_path):
    assert "too many edges are so near to each other" in checked(tmp_path, bundle(12, height=2.0**-1000)).reason


@pytest.mark.parametrize("offset", [0.0, 1e4])
def test_what_stays_clear_of_obstacles(tmp_path, offset):
    solids = (plate(2.0), sphere(5.0), rod(0, 0), box(4, 5))
    obstacles = [Obstacle(each.vertices + offset, each.faces) for each in solids]
    verdict = checked(tmp_path, trajectory([frame + offset for frame in rising(5, 0.5)], obstacles=obstacles))
    assert verdict == Verdict(True, 1, 5, obstacles=4)
    assert str(verdict) == "accepted: no contact on 5 legs in 1 stage, nor with 4 obstacles"


@pytest.mark.parametrize("obstacle", [plate(2.0), Obstacle([[-9, 1.0, 2.0], [9, 1.0, 2.0]], [[0, 1]])])
def test_a_leg_through_an_obstacle(tmp_path, obstacle):
    first, last = rising(1, 4.0)
    assert all(checked(tmp_path, trajectory([frame], obstacles=[obstacle])).accepted for frame in (first, last))
    verdict = checked(tmp_path, trajectory([first, first, last], obstacles=[box(7, 8), obstacle]))
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.obstacle) == (False, 0, 1, 1)
    (edge,) = verdict.edges or ()
    assert str(verdict).endswith(f"edge {edge + 1} meets obstacle 2 (counted from 1)")


def test_a_start_that_pierces_or_touches(tmp_path):
    for obstacle in (plate(0.0), rod(1.0, 0.0), box(-0.5, 2.0)):
        verdict = checked(tmp_path, trajectory([regular_polygon(20).vertices], obstacles=[obstacle]))
        assert (verdict.accepted, verdict.frame, verdict.obstacle) == (False, 0, 0)


def moved(*vertices):
    """A trefoil of which some vertices move in the second of two legs, by a unit in the last place."""
    frames = np.stack([PINNED.vertices] * 3)
    frames[2, vertices, 0] = np.nextafter(frames[2, vertices, 0], np.inf)
    return list(frames)


@pytest.mark.parametrize("mesh", ["fixed", "adaptive"])
def test_a_run_writes_its_pins_and_they_hold_on_every_mesh(tmp_path, mesh):
    record = Trajectory()
    for iterate in relax(*wanted(PINNED, pins=(3, 17), pin_tangents=True, mesh=mesh, max_iterations=12)):
        record.add(iterate)
    assert len(record.arrays()["pins"]) == 6
    verdict = checked(tmp_path, record.arrays())
    assert verdict.accepted
    assert str(verdict).endswith("; 6 pins in place")


def test_a_run_without_pins_says_nothing_of_them(tmp_path):
    record = Trajectory()
    for iterate in relax(PINNED, RelaxOptions(max_iterations=2)):
        record.add(iterate)
    assert "pins" not in record.arrays()


def test_a_pinned_vertex_that_moves_is_named(tmp_path):
    pins = PINNED.vertices[[3, 17]]
    assert checked(tmp_path, trajectory(moved(4, 16), pins=pins)).accepted
    verdict = checked(tmp_path, trajectory(moved(4, 17), pins=pins))
    assert (verdict.accepted, verdict.stage, verdict.frame, verdict.pins) == (False, 0, 1, 2)
    assert verdict.reason == "vertex 18 leaves pin 2 (counted from 1)"


def test_each_stage_has_a_vertex_at_each_pin(tmp_path):
    """Vertex 17 is left out where it lies on an edge: the same curve, but nothing holds it any more."""
    finer = np.insert(PINNED.vertices, 17, PINNED.vertices[[16, 17]].mean(axis=0), axis=0)
    stages = [finer], [PINNED.vertices]
    assert checked(tmp_path, trajectory(*stages, pins=finer[[3, 18]])).accepted
    verdict = checked(tmp_path, trajectory(*stages, pins=finer[[3, 17]]))
    assert (verdict.accepted, verdict.stage) == (False, 1)
    assert verdict.reason == "no vertex is at pin 2 (counted from 1)"
