"""Hops lead lower or nowhere, by proved ways that a seed determines, and an interrupt loses nothing."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import cycle, islice, pairwise
from pathlib import Path

import numpy as np
import pytest
from families import family
from mobius_flow.core import Curve, Iterate, Mesh, OptionError, RelaxOptions, Result, Status, Trajectory, minimize
from mobius_flow.core.collision import FreeMotion, Limit
from mobius_flow.core.curve import refine
from mobius_flow.core.descent import Point, Step
from mobius_flow.core.driver.moves import MOVES
from mobius_flow.core.driver.moves.hops import (
    IS_UNKNOT,
    MAY_BE_UNKNOT,
    MOTIONS,
    Hops,
    RandomMotion,
    is_circle,
    unknot_message,
)
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.relax import WithOutcome
from mobius_flow.core.driver.run import Run, iterates
from mobius_flow.core.knots import double, knot, torus_knot
from mobius_flow.core.proof import verify
from shapes import hopf_link, regular_polygon, torus_trefoil
from tasks import wanted

VERTICES = 90
OPTIONS = RelaxOptions(mesh="fixed", vertices=VERTICES, hops=1, seed=1)
Recorded = tuple[list[Iterate], Result]


def saddle() -> Curve:
    """The torus knot T(3, 4) in its most symmetric position, where plain descent ends though it is no minimum."""
    return torus_knot(3, 4, VERTICES)


def recorded(**changes: object) -> Recorded:
    found: list[Iterate] = []
    return found, minimize(saddle(), replace(OPTIONS, **changes), found.append)


@pytest.fixture(scope="module")
def hopped() -> Recorded:
    return recorded()


@pytest.fixture(scope="module")
def plain() -> Recorded:
    return recorded(hops=0)


def hop_of(found: list[Iterate]) -> Iterate:
    """The first hop: the one iterate whose way is longer than any step's."""
    return max(found, key=lambda iterate: len(iterate.path))


def same(a: list[Iterate], b: list[Iterate]) -> bool:
    return all(np.array_equal(x.curve.vertices, y.curve.vertices) for x, y in zip(a, b, strict=True))


def test_a_hop_leads_lower_and_is_told(hopped: Recorded, plain: Recorded) -> None:
    found, result = hopped
    assert result.status is Status.CONVERGED
    assert result.final_energy < 0.99 * plain[1].final_energy
    assert "hops that lowered the energy: 1 of 1" in result.message
    assert "hop" not in plain[1].message
    assert len(hop_of(found).path) > 20


def test_the_energy_never_rises(hopped: Recorded) -> None:
    energies = [iterate.energy for iterate in hopped[0]]
    assert all(b <= a for a, b in pairwise(energies))


def test_without_hops_nothing_changes_and_with_them_nothing_before(hopped: Recorded, plain: Recorded) -> None:
    bare = list(iterates(Run(start_problem(saddle(), OPTIONS), saddle(), OPTIONS), MOVES[:-1]))
    assert same(plain[0], bare)
    assert same(hopped[0][: len(bare)], bare)


def test_the_same_seed_gives_the_same_bits(hopped: Recorded) -> None:
    run = Run(start_problem(saddle(), OPTIONS), saddle(), OPTIONS)
    again = WithOutcome(iterates(run, MOVES))
    assert same(hopped[0], list(again))
    assert again.outcome is not None
    assert again.outcome.message == hopped[1].message
    tried = len(hop_of(hopped[0]).path)  # one leg each, since lengths are what they should be
    assert run.iterations == run.iterate.index + tried - 1, "the hop is one iterate, but all of its steps count"


def test_another_seed_gives_another_way(hopped: Recorded) -> None:
    hop = hop_of(hopped[0])
    start = Run(start_problem(saddle(), OPTIONS), hopped[0][hop.index - 1].curve, OPTIONS).point
    first, other = (next(MOTIONS[0](start, np.random.default_rng(seed))).point.placed for seed in (1, 2))
    np.testing.assert_allclose(first, hop.path[0], atol=1e-8)
    assert np.abs(other - hop.path[0]).max() > 1e-3


def test_motions_take_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    turns: list[type] = []

    def still(motion: RandomMotion, *_: object) -> Iterator[Step]:
        turns.append(type(motion))
        return iter(())

    for each in MOTIONS:
        monkeypatch.setattr(type(each), "__call__", still)
    assert "hops that lowered the energy: 0 of 5" in recorded(hops=5)[1].message
    assert turns == list(islice(cycle(map(type, MOTIONS)), 5))


def test_the_whole_way_is_certified(hopped: Recorded, tmp_path: Path) -> None:
    found, result = hopped
    trajectory = Trajectory()
    for iterate in found:
        trajectory.add(iterate)
    trajectory.save(tmp_path / "T.npz")
    assert result.certified
    assert verify(tmp_path / "T.npz").accepted
    assert hop_of(found).edge_length_error < 1e-6


@pytest.mark.slow
def test_more_hops_begin_with_the_same_ones_and_never_end_higher(hopped: Recorded, plain: Recorded) -> None:
    more, result = recorded(hops=2)
    assert same(more[: len(hopped[0])], hopped[0])
    assert plain[1].energies[-1] > hopped[1].energies[-1] >= result.energies[-1]


def test_an_interrupt_during_a_trial_keeps_the_lowest_curve(plain: Recorded, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(type(MOTIONS[0]), "__call__", interrupted)
    result = recorded()[1]
    assert result.status is Status.INTERRUPTED
    assert np.array_equal(result.curve.vertices, plain[1].curve.vertices)


def test_a_degenerate_trial_is_one_that_leads_nowhere(plain: Recorded, monkeypatch: pytest.MonkeyPatch) -> None:
    def degenerate(*_: object) -> None:
        raise np.linalg.LinAlgError

    monkeypatch.setattr(type(MOTIONS[0]), "__call__", degenerate)
    found, result = recorded()
    assert same(found, plain[0])
    assert result.message.endswith("; hops that lowered the energy: 0 of 1")


def test_a_way_is_certified_only_if_all_its_steps_are() -> None:
    def unproved(point: Point, rng: np.random.Generator) -> Iterator[Step]:
        step = next(MOTIONS[0](point, rng))
        yield replace(step, legs=tuple(leg._replace(proof=FreeMotion(1.0, limit=Limit.UNTESTED)) for leg in step.legs))

    options = replace(OPTIONS, max_iterations=2)
    for motion, certified in ((MOTIONS[0], True), (unproved, False)):
        run = Run(start_problem(saddle(), options), saddle(), options)
        Hops(run).hop(motion, np.inf)
        assert run.iterate.certified == certified


@pytest.mark.parametrize("left", family([0, 1, 10], every=2))
def test_iterations_of_trials_count(plain: Recorded, left: int) -> None:
    """With too few of them for a trial to lead lower, the run stays where it has converged, and says so."""
    found, result = recorded(max_iterations=plain[1].last.index + left)
    assert same(found, plain[0])
    assert result.status is Status.CONVERGED
    assert ("hops that lowered the energy: 0 of 1" in result.message) == (left > 0)


def test_a_trial_takes_no_more_iterations_than_are_left(plain: Recorded) -> None:
    """Its motion and its relaxation together."""
    options = replace(OPTIONS, max_iterations=plain[1].last.index + 10)
    run = Run(start_problem(saddle(), options), saddle(), options)
    list(WithOutcome(iterates(run, MOVES)))
    assert plain[1].last.index < run.iterations <= options.max_iterations


@pytest.mark.slow
def test_the_mesh_becomes_finer_before_and_after(tmp_path: Path) -> None:
    trajectory = Trajectory()
    result = minimize(saddle(), RelaxOptions(mesh="finer", vertices=VERTICES, hops=1, seed=1), trajectory.add)
    trajectory.save(tmp_path / "T.npz")
    assert "hops that lowered the energy: 1 of 1" in result.message
    assert verify(tmp_path / "T.npz").accepted


def test_at_the_circle_there_is_nothing_to_look_for() -> None:
    result = minimize(regular_polygon(40), RelaxOptions(hops=3))
    assert "hop" not in result.message


def test_a_circle_that_is_held_may_be_left() -> None:
    """Only where nothing is in the way has no curve less energy."""
    task, options = wanted(regular_polygon(16), hops=1, pins=(0, 8), vertices=16, mesh="fixed", tolerance=1e-2)
    assert "of 1" in minimize(task, options).message


def test_below_a_straight_arc_there_is_nothing() -> None:
    arc = Curve(np.linspace(0.0, 1.0, 13)[:, None] * [1.0, 2.0, 2.0], Mesh((13,), (False,)))
    assert "hop" not in minimize(arc, RelaxOptions(hops=1, vertices=13, mesh="fixed")).message


def test_where_all_is_pinned_there_is_nowhere_to_go() -> None:
    task, options = wanted(torus_trefoil(20), pins=tuple(range(20)), vertices=20, mesh="fixed", hops=1)
    assert "hop" not in minimize(task, options).message


def test_methods_that_penalise_lengths_make_no_hops() -> None:
    result = minimize(torus_trefoil(60), RelaxOptions(method="penalty-lbfgs", hops=1, tolerance=1e-2))
    assert "hop" not in result.message


def test_composite_knots_make_no_hops() -> None:
    options = RelaxOptions(hops=1, tolerance=1e-2)
    result = minimize(knot("3_1#3_1"), options)
    assert "composite" in result.message
    assert "hop" not in result.message


# -- unknots that are no circles -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("hops", "advice"), [(0, "hops may reach it"), (1, "more hops may reach it")])
def test_an_unknot_above_the_circle_is_never_called_done(hops: int, advice: str) -> None:
    at_rest = RelaxOptions(tolerance=1e6, edge_lengths="keep", mesh="fixed", max_iterations=1, hops=hops)
    result = minimize(knot("culprit"), at_rest)
    assert result.status is Status.CONVERGED
    assert result.message.endswith(f"; {IS_UNKNOT}: {advice}")


def test_a_knot_that_polynomials_do_not_tell_from_the_unknot_may_be_one() -> None:
    """The untwisted double of the trefoil is knotted, with Δ = 1, and of too many crossings for the table."""
    assert unknot_message(double(knot("3_1"), 0)) == MAY_BE_UNKNOT


def test_strands_that_no_view_tells_apart_leave_the_type_open() -> None:
    """A figure eight whose strands pass at 10⁻¹² of its size, as they may where a curve is stuck."""
    eight = np.array([[-1, -1, 0], [1, 1, 1e-12], [2, 0, 0], [1, -1, 0], [-1, 1, 0], [-2, 0, 0]])
    assert unknot_message(Curve(eight)) == MAY_BE_UNKNOT


def test_the_type_of_a_curve_of_very_many_vertices_is_not_looked_at() -> None:
    culprit = knot("culprit")
    assert unknot_message(refine(culprit, 10_000)) == IS_UNKNOT
    assert unknot_message(refine(culprit, 10_000 + 1)) is None


def test_knots_links_circles_and_what_is_not_in_space_are_no_case_for_it() -> None:
    for curve in (knot("8_19"), hopf_link(40), regular_polygon(40), Curve(regular_polygon(40).vertices[:, :2])):
        assert unknot_message(curve) is None


def test_a_circle_is_told_from_what_is_wound_like_one() -> None:
    angles = np.sort(np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, 60))
    uneven = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    assert is_circle(Curve(uneven))
    assert is_circle(Curve(100.0 + uneven @ np.linalg.qr(np.arange(9.0).reshape(3, 3) ** 2)[0]))
    assert not is_circle(Curve(uneven * [1.0, 0.5, 1.0]))
    assert not is_circle(torus_knot(9, 2, 400))
    assert not is_circle(hopf_link(40))


# -- options ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("change", [{"hops": -1}, {"hops": 1.5}, {"seed": -1}, {"seed": None}])
def test_bad_values_are_refused(change: dict[str, object]) -> None:
    with pytest.raises(OptionError, match=next(iter(change))):
        RelaxOptions(**change)
