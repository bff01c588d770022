"""Relaxations among obstacles: whatever the mesh, no motion touches one, and the verifier agrees."""

import numpy as np
import pytest
from families import family
from mobius_flow.core import Curve, CurveError, MobiusFlowError, Obstacle, Status, Task, Trajectory, minimize, relax
from mobius_flow.core.collision import Contact
from mobius_flow.core.curve import at_edges
from mobius_flow.core.descent import NoStep
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.knots import knot, scramble
from shapes import regular_polygon, torus_trefoil
from solids import box, plate, rod
from tasks import proved, wanted


def test_a_leg_through_a_wall_is_not_proved():
    curve, up = torus_trefoil(30), np.array([0.0, 0.0, 1.0])
    problem = start_problem(*wanted(curve, vertices=30, avoid=(plate(1.3, name="wall"),)))
    room = 1.3 - curve.vertices[:, 2].max()
    assert problem.free_motion(curve.vertices, curve.vertices + 0.9 * room * up).proved
    through = problem.free_motion(curve.vertices, curve.vertices + up)
    assert not through.proved
    assert 0.9 * room < through.time <= room
    assert through.contact.obstacle == "obstacle wall"


TANGLE = scramble(knot("3_1", vertices=40), seed=3, moves=150)
LOW, HIGH = float(TANGLE.vertices.min()), float(TANGLE.vertices.max())
AROUND = box(LOW - 0.02 * (HIGH - LOW), HIGH + 0.02 * (HIGH - LOW))
RINGS = Curve.from_components([regular_polygon(30).vertices + np.array([2.1 * k, 0.0, 0.1 * k]) for k in range(2)])


@pytest.mark.parametrize(
    ("curve", "walls", "options"),
    [
        (TANGLE, [AROUND], {"mesh": "adaptive"}),
        pytest.param(TANGLE, [AROUND], {"mesh": "finer"}, marks=pytest.mark.slow),
        (TANGLE, [AROUND], {"hops": 1}),
        pytest.param(TANGLE, [AROUND], {"escape_saddles": True}, marks=pytest.mark.slow),
        pytest.param(
            torus_trefoil(1600), [rod(0, 0), plate(1.3), box(9, 10)], {"max_iterations": 40}, marks=pytest.mark.slow
        ),
        (RINGS, [rod(-1.2, 0.0), rod(3.4, 0.0)], {"max_iterations": 60}),
    ],
    ids=["adaptive", "finer", "hops", "saddles", "coarse start", "drifting apart"],
)
def test_changes_of_mesh_and_shape_stay_clear(curve, walls, options):
    result, _ = proved(curve, avoid=walls, **{"max_iterations": 20} | options)
    assert result.report()["obstacles"] == len(walls)
    assert len(result.curve) >= 1600 or len(curve) < 1600


@pytest.mark.kernels
@pytest.mark.parametrize("half", family([1.05, 1.3]))
def test_little_is_left_to_gain_where_a_run_has_converged(half):
    """Though the energy of the walls, most of the objective, makes the bound on the gradient wider.

    Three pins keep the ring from turning in the box, which costs hardly any energy, and from saddles, which a run may
    end at or leave as rounding has it.
    """
    t = 2.0 * np.pi * np.arange(48) / 48
    ring = Curve(np.column_stack([np.cos(t), np.sin(t), 0.3 * np.cos(2 * t) + 0.1 * np.sin(3 * t)]))
    still = {"avoid": [box(-half, half)], "pins": (0, 16, 32), "vertices": 48}
    sharper = {"method": "trust-region", "tolerance": 1e-7}
    usual, sharp = (minimize(*wanted(ring, **still, **more)) for more in ({}, sharper))
    assert usual.status is sharp.status is Status.CONVERGED
    assert usual.last.energy > 5.0 * usual.final_energy
    assert abs(usual.last.energy / sharp.last.energy - 1.0) < 1e-8
    assert usual.final_energy == pytest.approx(sharp.final_energy, rel=1e-3)


def test_what_no_step_gets_past_is_named():
    stuck = NoStep.because(Contact((4,), "obstacle box"))
    assert stuck.reason == "edge 5 and obstacle box are so close that no step is free of contact"
    assert at_edges(regular_polygon(24), stuck.limited_by.edges).vertices == (4, 5)


@pytest.mark.parametrize(
    ("curve", "wall", "said"),
    [
        (torus_trefoil(30), plate(0.3, name="wall"), r"edge \d+ of component 1 pierces obstacle wall at \(.*\); move"),
        (regular_polygon(30, dimension=2), plate(0.3), "the curve has dimension 2, but obstacles are in space"),
        (torus_trefoil(30), plate(-2.0, 1e14, "wall"), r"^obstacle wall reaches some \de\+1[34] times the curve's"),
        (
            torus_trefoil(30),
            plate(-2.0, 1e40, "wall"),
            r"^obstacle wall reaches some \de\+(39|40) times .* length; cut",
        ),
        (
            torus_trefoil(30).with_vertices(1e-20 * torus_trefoil(30).vertices),
            Obstacle(plate(-2.0, 9.0).vertices * [1.0, 1.0, 1e-20], plate(-2.0).faces, "wall"),
            r"^obstacle wall reaches some \de\+(19|20) times",  # not coordinates in units that nobody knows
        ),
    ],
)
def test_what_pierces_or_is_too_large_for_its_repulsion_is_refused(curve, wall, said):
    with pytest.raises(CurveError, match=said):
        relax(*wanted(curve, avoid=(wall,), vertices=30))


def test_obstacles_are_a_tuple_or_a_list():
    wall = plate(1.0)
    for value in (wall, "wall.obj", [[0.0, 0.0]], 3, None):
        with pytest.raises(MobiusFlowError, match=r"obstacles is .*; give a tuple, each an Obstacle$"):
            Task(curve=torus_trefoil(30), obstacles=value)
    assert Task(curve=torus_trefoil(30), obstacles=[wall]).obstacles == (wall,)
    assert isinstance(Trajectory(obstacles=[wall]).arrays()["obstacle_000_faces"], np.ndarray)
