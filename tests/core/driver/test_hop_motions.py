"""Ways out of a minimum: proved, on the constraints, below their ceilings, and far."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.core import Curve, RelaxOptions
from mobius_flow.core.descent import Point
from mobius_flow.core.driver.moves.hops import MOTIONS, RandomMotion, Stir, radius, root_mean_square
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.knots import torus_knot
from mobius_flow.lab import starts


@cache
def saddle(**options: object) -> Point:
    """The torus knot T(3, 4) in its most symmetric position."""
    return at(torus_knot(3, 4, 90), **options)


def at(curve: Curve, **options: object) -> Point:
    return start_problem(curve, RelaxOptions(mesh="fixed", vertices=len(curve), **options)).at_curve(curve)


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda motion: type(motion).__name__)
def test_motions_stay_on_the_constraints_below_their_ceilings_and_go_far(motion: RandomMotion) -> None:
    start = saddle()
    steps = list(motion(start, np.random.default_rng(0)))
    assert len(steps) > 20
    assert all(step.certified for step in steps)
    assert all(step.point.infeasibility < 1e-9 for step in steps)
    assert max(step.point.energy for step in steps) < 16.0 * start.energy
    moved = root_mean_square(steps[-1].point.vertices - start.vertices)
    assert moved > 0.5 * radius(start.vertices)


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda motion: type(motion).__name__)
def test_a_ceiling_ends_a_motion(motion: RandomMotion) -> None:
    low = type(motion)(ceilings=(1.02, 1.02))
    steps = list(low(saddle(), np.random.default_rng(0)))
    assert steps
    assert max(step.point.energy for step in steps) < 1.02 * saddle().energy


def test_motions_fit_where_lengths_are_prescribed() -> None:
    assert all(motion.fits(saddle(energy=energy)) for motion in MOTIONS for energy in ("moebius", "edge"))
    assert not any(motion.fits(saddle(method="penalty-lbfgs")) for motion in MOTIONS)


def test_flows_have_no_divergence() -> None:
    flow = Stir().field(saddle(), np.random.default_rng(0))
    x, h = np.array([[0.3, -0.2, 0.1]]), 1e-5
    divergence = sum((flow(x + h * e)[0] - flow(x - h * e)[0]) @ e for e in np.eye(3)) / (2.0 * h)
    assert abs(divergence) < 1e-8


def test_a_way_is_as_long_as_asked_and_steps_grow_again_where_there_is_room() -> None:
    """From a start with little room below the ceiling, and then turning about an axis, which costs nothing."""
    start, stride = saddle(), 0.2
    rough = np.random.default_rng(4).normal(size=start.vertices.shape)

    def field(x: np.ndarray) -> np.ndarray:
        return rough if np.array_equal(x, start.vertices) else np.cross([0.0, 0.0, 1.0], x)

    steps = list(Stir(stride=stride, shortest=1e-3).along(start, field, 1.02 * start.energy))
    places = [start.vertices, *(step.point.vertices for step in steps)]
    ways = [root_mean_square(b - a) / radius(a) for a, b in pairwise(places)]
    assert ways[0] < 0.6 * stride
    assert max(ways) == pytest.approx(stride, rel=0.1)
    assert 1.0 - stride < sum(ways) < 1.0 + stride


def test_a_field_that_constraints_hold_back_moves_nothing() -> None:
    """What is left of a translation, with the barycenter held, is rounding errors."""
    assert not list(Stir().along(saddle(), np.ones_like, np.inf))


def test_starts_of_a_batch_that_hop_take_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[int] = []
    monkeypatch.setattr(starts, "MOTIONS", [lambda point, rng, k=k: taken.append(k) or () for k in range(2)])
    for number in range(5, 12):
        starts.start("3_1", number, number)
    assert taken == [0, 1, 0, 1]
