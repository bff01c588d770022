"""Directions of descent by their formulas, and what searches along them promise."""

from itertools import pairwise

import numpy as np
import pytest
from descent_cases import DIRECTIONS, GEOMETRIES, RULES, SEARCHES, narrow, start
from descent_contracts import (
    assert_armijo,
    assert_certified,
    assert_feasible,
    assert_weak_wolfe,
    point_on,
    taken,
    with_geometry,
)
from mobius_flow.core import Curve
from mobius_flow.core.collision import Contact
from mobius_flow.core.descent import NoStep, SearchState, Step
from mobius_flow.core.descent.directions import ConjugateGradient, LimitedMemoryBFGS, SteepestDescent
from mobius_flow.core.descent.line_searches import Armijo, FirstTrial, LineSearch
from mobius_flow.core.descent.step import Leg, Rejected, attempt
from mobius_flow.lab.methods import Penalised, WeakWolfe
from shapes import hopf_link, torus_trefoil
from taylor import taylor_slope


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("search", SEARCHES)
def test_line_searches_keep_their_promises(search, direction, geometry):
    point, state = start(geometry), SearchState()
    for _ in range(4):
        along, _ = DIRECTIONS[direction].propose(point, state.memory)
        step, state = taken(LineSearch(DIRECTIONS[direction], SEARCHES[search]).step(point, state))
        if search == "armijo":
            assert_armijo(point, step, along)
        else:
            assert_weak_wolfe(point, step, along)
        assert_certified(point, step)
        assert_feasible(step)
        point = step.point


@pytest.mark.parametrize("name", RULES)
def test_other_rules_keep_theirs(name):
    rule, geometry = RULES[name]
    point, state = start(geometry), SearchState()
    for _ in range(4):
        step, state = taken(rule.step(point, state))
        assert step.point.energy < point.energy
        assert_certified(point, step)
        assert_feasible(step)
        point = step.point


@pytest.mark.parametrize("name", [*RULES, *(f"{s} {g}" for s in SEARCHES for g in GEOMETRIES)])
def test_no_leg_is_taken_that_is_not_proved(name):
    rule, geometry = RULES.get(name) or (LineSearch(SteepestDescent(), SEARCHES[name.split()[0]]), name.split()[1])
    width = 1e-3
    point = narrow(start(geometry), width)
    step, _ = taken(rule.step(point, SearchState()))
    corners = [point, *(leg.end for leg in step.legs)]
    for a, b in pairwise(corners):
        assert np.abs(b.placed - a.placed).max() / point.problem.units.scale <= width
    assert step.limited_by == Contact((0, 2))


@pytest.mark.parametrize("name", [*RULES, *(f"{s} {g}" for s in SEARCHES for g in GEOMETRIES)])
def test_what_can_not_be_proved_is_said(name):
    rule, geometry = RULES.get(name) or (LineSearch(SteepestDescent(), SEARCHES[name.split()[0]]), name.split()[1])
    step, _ = rule.step(narrow(start(geometry), 0.0), SearchState())
    assert isinstance(step, NoStep)
    assert step.limited_by == Contact((0, 2))
    assert "edge 1 and edge 3 are so close" in step.reason


def test_a_chord_through_a_strand_is_rejected():
    """Both ends are good, the straight way between them is not."""
    link = hopf_link(20)
    point = with_geometry(point_on(link), Penalised())
    apart = point.vertices + (np.arange(40) >= 20)[:, None] * [3.0, 0.0, 0.0]
    trial = attempt(point, apart, point.residual, lambda q: True)
    assert isinstance(trial, Rejected)
    assert 0.0 < trial.proof.time < 1.0
    assert trial.in_the_way is not None
    nearer = point.vertices + 0.5 * trial.proof.time * (apart - point.vertices)
    assert isinstance(attempt(point, nearer, point.residual, lambda q: True), Leg)


def crossed_rods():
    """Two thin triangles with a gap of 1 between edges that cross when seen from above."""
    lower = [[-2.0, 0, 0], [2, 0, 0], [0, 0, -3]]
    upper = [[0.0, -2, 1], [0, 2, 1], [0, 0.5, 4]]
    return point_on(Curve.from_components([lower, upper]))


def test_the_first_trial_is_two_thirds_of_the_first_contact():
    point = crossed_rods()
    down = (np.arange(6) >= 3)[:, None] * [0.0, 0.0, -1.0]
    contact = 1.0 / point.problem.units.scale
    tau, met = FirstTrial(max_displacement=100.0)(point, down, np.inf)
    assert tau == pytest.approx(2 / 3 * contact, rel=0.02)
    assert sorted(met.edges) == [0, 3]


def test_the_first_trial_is_bounded():
    point = crossed_rods()
    up = (np.arange(6) >= 3)[:, None] * [0.0, 0.0, 4.0]
    assert FirstTrial()(point, up, np.inf) == (0.5 / 4.0, None)
    assert FirstTrial()(point, up, 0.01) == (0.01, None)
    assert FirstTrial()(point, 0.0 * up, np.inf) == (0.0, None)


@pytest.mark.parametrize(("lengths", "bounded"), [("keep", True), ("equal", False)])
def test_step_sizes_recover_where_the_way_to_the_lengths_made_them_short(lengths, bounded):
    point = point_on(start().curve, edge_lengths=lengths)
    step = Armijo().along(point, -point.gradient, np.inf, 1e-100)
    assert isinstance(step, Step) != bounded  # a motion of 10⁻¹⁰⁰ changes no coordinate
    if isinstance(step, Step):
        assert 1e-5 < np.abs(step.size * point.gradient).max() <= 1e-3


def test_steps_grow_by_a_bounded_factor():
    point = start()
    step, _ = taken(LineSearch(SteepestDescent(), Armijo()).step(point, SearchState(None, 1e-5)))
    assert step.size <= 4e-5


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_conjugate_gradients_by_their_formula(geometry):
    rule = ConjugateGradient()
    last = start(geometry)
    before, memory = rule.propose(last, None)
    np.testing.assert_array_equal(before, -last.gradient)
    betas = []
    for _ in range(8):
        step = Armijo().along(last, before, np.inf, np.inf)
        assert isinstance(step, Step)
        point = step.point
        direction, memory = rule.propose(point, memory)
        u, inner = point.gradient, point.tangent_space.apply
        overlap = np.sum(u * inner(u - point.transport(last.gradient)))
        betas.append(max(0.0, overlap / np.sum(last.gradient * last.tangent_space.apply(last.gradient))))
        expected = -u + betas[-1] * point.transport(before)
        np.testing.assert_allclose(direction, expected, atol=1e-8 * np.abs(expected).max())
        last, before = point, direction
    assert max(betas) > 0.05


def test_lbfgs_satisfies_the_secant_equation():
    """H y = s for the last displacement s and difference y of gradients, where nothing is constrained.

    The same pair once more, from the end back to the start, leaves H as it is.
    """
    first = start("penalised")
    rule = LimitedMemoryBFGS(inverse=lambda covector: first.tangent_space.gradient(covector)[0])
    d, memory = rule.propose(first, None)
    step = WeakWolfe().along(first, d, 1.0, np.inf)
    assert isinstance(step, Step)
    point = step.point
    there, memory = rule.propose(point, memory)
    here, _ = rule.propose(first, memory)
    _, ((s, y),) = memory
    np.testing.assert_allclose(y, point.derivative - first.derivative)
    np.testing.assert_allclose(here - there, s, atol=1e-9 * np.abs(s).max())


@pytest.mark.parametrize("penalty", [1.0, 1e4])
def test_the_penalised_energy_has_slope_two(penalty):
    curve = torus_trefoil(40)
    point = with_geometry(point_on(curve), Penalised(penalty))
    rng = np.random.default_rng(5)
    stretched = point.problem.at(point.vertices * [1.1, 0.9, 1.0] + 0.01 * rng.normal(size=point.vertices.shape))
    v = 0.01 * rng.normal(size=point.vertices.shape)
    terms = [stretched.energy, float(np.sum(stretched.derivative * v))]
    slope = taylor_slope(lambda t: stretched.problem.at(stretched.vertices + t * v).energy, terms, largest=1.0)
    assert slope == pytest.approx(2, abs=0.1)
    lengths = stretched.problem.constraints.lengths
    by_hand = penalty * np.sum(lengths * np.log(stretched.curve.edge_lengths / lengths) ** 2)
    assert stretched.energy - stretched.problem.objective.value(stretched.curve) == pytest.approx(by_hand)
