"""Relaxations among obstacles: whatever the method and the mesh, no motion touches one, and the verifier agrees."""

import numpy as np
import pytest
from families import family
from mobius_flow.core import (
    METHODS,
    Curve,
    CurveError,
    MobiusFlowError,
    Obstacle,
    RelaxOptions,
    Status,
    Task,
    Trajectory,
    minimize,
    relax,
)
from mobius_flow.core.collision import Contact
from mobius_flow.core.curve import at_edges
from mobius_flow.core.descent import NoStep
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.knots import knot, scramble
from mobius_flow.core.proof import verify
from shapes import regular_polygon, torus_trefoil
from solids import box, plate, rod
from tasks import wanted

NEAR = (plate(0.95, name="ceiling"), plate(-0.95, name="floor"))  # a relaxed trefoil would rise through them

SHARP = {"method": "trust-region", "tolerance": 1e-7}


def verified(curve, tmp_path, **settings):
    """The result of a run whose trajectory is accepted, with its obstacles."""
    task, options = wanted(curve, **settings)
    trajectory = Trajectory(obstacles=task.obstacles)
    result = minimize(task, options, trajectory.add)
    trajectory.save(tmp_path / "T.npz")
    verdict = verify(tmp_path / "T.npz")
    assert verdict.accepted, str(verdict)
    assert verdict.obstacles == len(task.obstacles) == result.report()["obstacles"]
    assert result.certified
    return result


def flat_trefoil(n=40):
    curve = torus_trefoil(n)
    return curve.with_vertices(curve.vertices * [1.0, 1.0, 0.9])


def test_a_leg_through_a_wall_is_not_proved():
    curve, up = torus_trefoil(30), np.array([0.0, 0.0, 1.0])
    problem = start_problem(*wanted(curve, vertices=30, avoid=(plate(1.3, name="wall"),)))
    room = 1.3 - curve.vertices[:, 2].max()
    assert problem.free_motion(curve.vertices, curve.vertices + 0.9 * room * up).proved
    through = problem.free_motion(curve.vertices, curve.vertices + up)
    assert not through.proved
    assert 0.9 * room < through.time <= room
    assert through.contact is not None
    assert through.contact.obstacle == "obstacle wall"


@pytest.mark.parametrize("method", family(METHODS, every=3))
def test_no_method_goes_through_a_wall(method, tmp_path):
    result = verified(flat_trefoil(), tmp_path, method=method, max_iterations=6, vertices=40, mesh="fixed", avoid=NEAR)
    assert np.abs(result.curve.vertices[:, 2]).max() < 0.95


def test_without_the_wall_it_goes_there():
    """The test above is about something."""
    result = minimize(flat_trefoil(), RelaxOptions(max_iterations=6, vertices=60, mesh="fixed"))
    assert np.abs(result.curve.vertices[:, 2]).max() > 1.0
    assert result.report()["obstacles"] == 0


@pytest.mark.parametrize(
    "more", family([{"mesh": "adaptive"}, {"mesh": "finer"}, {"hops": 1}, {"escape_saddles": True}], every=2)
)
def test_changes_of_mesh_and_shape_stay_clear(more, tmp_path):
    curve = scramble(knot("3_1", vertices=40), seed=3, moves=150)
    low, high = float(curve.vertices.min()), float(curve.vertices.max())
    container = box(low - 0.02 * (high - low), high + 0.02 * (high - low))
    verified(curve, tmp_path, max_iterations=20, avoid=[container], **more)


@pytest.mark.kernels
@pytest.mark.parametrize("half", family([1.05, 1.3]))
def test_little_is_left_to_gain_where_a_run_has_converged(half):
    """Though the energy of the walls, most of the objective, makes the bound on the gradient wider.

    Three pins keep the ring from turning in the box, which costs hardly any energy, and from saddles, which a run may
    end at or leave as rounding has it.
    """
    t = 2.0 * np.pi * np.arange(48) / 48
    ring = Curve(np.column_stack([np.cos(t), np.sin(t), 0.3 * np.cos(2 * t) + 0.1 * np.sin(3 * t)]))
    still = {"avoid": [box(-half, half)], "pins": (0, 16, 32)}
    usual, sharp = (minimize(*wanted(ring, vertices=48, **still, **more)) for more in ({}, SHARP))
    assert usual.status is sharp.status is Status.CONVERGED
    assert usual.last.energy > 5.0 * usual.final_energy
    assert abs(usual.last.energy / sharp.last.energy - 1.0) < 1e-8
    assert usual.final_energy == pytest.approx(sharp.final_energy, rel=1e-3)


@pytest.mark.slow
def test_a_coarse_start_stays_clear(tmp_path):
    curve = torus_trefoil(1600)
    walls = (rod(0.0, 0.0), plate(1.3), box(9.0, 10.0))
    result = verified(curve, tmp_path, max_iterations=40, avoid=walls)
    assert len(result.curve) >= 1600


def test_links_that_drift_apart_stay_clear(tmp_path):
    rings = [regular_polygon(30).vertices + np.array([2.1 * k, 0.0, 0.1 * k]) for k in range(2)]
    rods = (rod(-1.2, 0.0), rod(3.4, 0.0))
    verified(Curve.from_components(rings), tmp_path, max_iterations=60, avoid=rods)


def test_a_curve_stays_on_its_side_of_a_rod(tmp_path):
    """A circle around a rod winds around it once in the end, as in the beginning."""
    curve = regular_polygon(60).with_vertices(regular_polygon(60).vertices * [3.0, 0.5, 1.0] + [2.5, 0.0, 0.0])
    result = verified(curve, tmp_path, max_iterations=60, vertices=60, avoid=(rod(0.0, 0.0),))
    x, y, _ = result.curve.vertices.T
    angles = np.unwrap(np.arctan2(np.append(y, y[0]), np.append(x, x[0])))
    assert angles[-1] - angles[0] == pytest.approx(2 * np.pi)


def test_what_no_step_gets_past_is_named():
    stuck = NoStep.because(Contact((4,), "obstacle box"))
    assert stuck.reason == "edge 5 and obstacle box are so close that no step is free of contact"
    assert stuck.limited_by is not None
    assert at_edges(regular_polygon(24), stuck.limited_by.edges).vertices == (4, 5)


def test_a_start_that_pierces_is_refused():
    with pytest.raises(CurveError, match=r"edge \d+ of component 1 pierces obstacle wall at \(.*\); move one"):
        relax(*wanted(torus_trefoil(30), avoid=(plate(0.3, name="wall"),)))
    with pytest.raises(CurveError, match="the curve has dimension 2, but obstacles are in space"):
        relax(*wanted(regular_polygon(30, dimension=2), avoid=(plate(0.3),)))


@pytest.mark.parametrize(
    ("size", "unit", "reach"), [(1e14, 1.0, r"\de\+1[34]"), (1e40, 1.0, r"\de\+(39|40)"), (9.0, 1e-20, r"\de\+(19|20)")]
)
def test_an_obstacle_too_large_for_its_repulsion_is_refused(size, unit, reach):
    """Its size is told, not coordinates in units that nobody knows."""
    curve, wall = torus_trefoil(30), plate(-2.0, size, "wall")
    wall = Obstacle(wall.vertices * [1.0, 1.0, unit], wall.faces, "wall")
    with pytest.raises(CurveError, match=f"^obstacle wall reaches some {reach} times the curve's length; cut"):
        relax(*wanted(curve.with_vertices(unit * curve.vertices), avoid=(wall,), vertices=30))


def test_the_repulsion_of_large_obstacles_is_right():
    """Beyond some size the objective sees no difference any more, up to the largest that is not refused."""
    curve = torus_trefoil(30)
    tasks = [wanted(curve, avoid=(plate(-2.0, size),), vertices=30, max_iterations=0) for size in (1e7, 1e11)]
    energies = [minimize(*each).energies[0] for each in tasks]
    assert energies[1] == pytest.approx(energies[0], rel=1e-6)


@pytest.mark.parametrize("value", [plate(1.0), "wall.obj", [[0.0, 0.0]], 3, None])
def test_what_is_no_tuple_of_obstacles_is_refused(value):
    with pytest.raises(MobiusFlowError, match=r"obstacles is .*; give a tuple, each an Obstacle$"):
        Task(curve=torus_trefoil(30), obstacles=value)


def test_a_list_becomes_a_tuple():
    wall = plate(1.0)
    assert Task(curve=torus_trefoil(30), obstacles=[wall]).obstacles == (wall,)
    assert isinstance(Trajectory(obstacles=[wall]).arrays()["obstacle_000_faces"], np.ndarray)
    assert isinstance(wall, Obstacle)
