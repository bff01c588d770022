"""Knots pulled tight: equilibrium at rest, proofs of the way, starts, open ropes, and known lengths."""

from dataclasses import replace
from itertools import count, islice
from types import SimpleNamespace

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh, OptionError, Status, Task, tighten
from mobius_flow.core.base.deadline import TimeLimit
from mobius_flow.core.collision import thickness
from mobius_flow.core.curve import subdivide
from mobius_flow.core.driver import WithOutcome, relax
from mobius_flow.core.driver.relax import within
from mobius_flow.core.knots import knot, overhand
from mobius_flow.core.ropes import TightenOptions, tightening
from mobius_flow.core.ropes.interior_point import InteriorPoint
from mobius_flow.core.ropes.pulled_rope import PulledRope
from tasks import check

RING = np.exp(2j * np.pi * np.arange(60) / 60)
CIRCLE = np.stack([RING.real, RING.imag, 0 * RING.real], axis=1)
T = np.linspace(-2.0, 2.0, 41)
WAVE = np.stack([T, 0.2 * np.sin(3 * T), 0.0 * T], axis=1)
BESIDE = Curve.from_components(
    [WAVE, CIRCLE + np.array([0.0, 4.0, 0.0])], (False, True)
)  # an open rope and a closed one
HOPF = Curve.from_components([CIRCLE, CIRCLE[:, [0, 2, 1]] + [1.0, 0.0, 0.0]])


def run(curve, **settings):
    iterates = []
    result = tighten(curve, callback=iterates.append, **settings)
    assert result.certified
    return iterates, result.outcome


@pytest.mark.parametrize(
    ("curve", "ropelength", "error"),
    [(knot("3_1"), 32.7436, 1e-3), (HOPF, 8.0 * np.pi, 5e-4)],
    ids=["trefoil", "Hopf link"],
)
def test_knots_reach_known_ropelengths_as_proved_ropes(curve, ropelength, error):
    iterates, outcome = run(curve, vertices=200)
    assert outcome.converged, outcome.message
    last = iterates[-1].curve
    assert ropelength < last.length / thickness(last) < (1.0 + error) * ropelength
    assert len(last) == 200
    verdict = check(iterates)
    assert min(verdict.radius) > 0.89 * thickness(iterates[0].curve)
    assert min(verdict.radius) == pytest.approx(thickness(last), rel=1e-5)
    assert outcome.ropelength == pytest.approx(last.length / thickness(last))
    # struts and bends carry the tension together: Σ force × distance is the length if nothing bends as much as it can
    assert 0.2 * outcome.ropelength < 2.0 * sum(strut.force for strut in outcome.struts) < 1.01 * outcome.ropelength
    assert "Strut" not in repr(outcome)  # of thousands
    assert iterates[-1].energy == pytest.approx(last.length / thickness(last), rel=1e-5)


def test_what_is_tight_is_not_let_loose():
    first = run(knot("3_1"), vertices=100)[0]
    again = [iterate.energy for iterate in run(first[-1].curve, vertices=100)[0]]
    assert max(again) < 1.2 * min(again)


def test_what_is_tight_is_only_refined_and_ends_on_splines(monkeypatch):
    run = InteriorPoint.run
    ring = np.exp(2j * np.pi * np.arange(100) / 100)
    ring = np.stack([ring.real, ring.imag, 0.0 * ring.real], axis=1)
    tight = Curve.from_components([ring, ring[:, [0, 2, 1]] + [1.0, 0.0, 0.0]])
    iterates = list(islice(tightening(Task(curve=tight), TightenOptions(vertices=800)), 9))
    check(iterates)
    assert [len(each.curve) for each in iterates[-5:]] == [400, 400, 800, 800, 800]
    assert iterates[-1].energy < 8.0 * np.pi * 1.003
    # and is pulled as it is, if finer meshes are blocked
    monkeypatch.setattr(PulledRope, "refined", lambda *_: iter(()))
    monkeypatch.setattr(InteriorPoint, "run", lambda point, gap: [*islice(run(point, gap), 1)])
    *_, last = tightening(Task(curve=tight), TightenOptions(vertices=800))
    assert len(last.curve) == 200


def test_strands_that_touch_everywhere_are_not_tight_yet():
    """As those of a closed braid, whose two strands have the same distance all along."""
    first = next(tightening(Task(curve=knot("7_1", 400)), TightenOptions(vertices=100)))
    assert not PulledRope(first, first.radius[0]).is_tight


def test_an_unknot_becomes_the_circle_of_its_rope():
    iterates, outcome = run(Curve(CIRCLE * [1.0, 2.0, 1.0] + 0.1 * CIRCLE[:, [2, 2, 0]]), vertices=100)
    last = iterates[-1].curve
    assert last.length / thickness(last) == pytest.approx(2.0 * np.pi, rel=1e-3)
    assert "circles" in outcome.message


def test_only_what_is_no_knot_is_left_to_the_flow_and_its_moves(monkeypatch):
    """Forces balance in an unknot that is packed, which nothing but the flow undoes."""
    begun = []

    def noted(start, options):
        begun.append(start.curve)
        return relax(start, options)

    monkeypatch.setitem(tightening.__wrapped__.__globals__, "relax", noted)
    for curve in (HOPF, knot("3_1", 60), Curve(CIRCLE)):
        next(tightening(Task(curve=curve), TightenOptions()))
    assert [len(curve.mesh.component_sizes) for curve in begun] == [1]
    assert np.ptp(begun[0].vertices[:, 2]) == 0.0  # the circle


def test_strands_that_keep_away_from_afar_find_shorter_shapes():
    """With the flow's own barrier 8_21 ends at 67.8."""
    assert tighten(knot("8_21", 100), vertices=100).outcome.ropelength < 66.5


@pytest.mark.parametrize("factor", [0.6, 1.7])
def test_ropes_shrink_and_grow_by_a_twentieth_a_leg(factor):
    """Before they are pulled, where corners are too sharp for their thickness though arcs of the rope fit in."""
    rope = PulledRope(first := next(tightening(Task(curve=HOPF), TightenOptions(vertices=100))), first.radius[0])
    rope.last = replace(first, curve=first.curve.with_vertices(factor * first.curve.vertices))
    lengths = np.array([rope.curve.length, *(each.curve.length for each in rope.shrunk())])
    assert np.abs(np.log(lengths[1:] / lengths[:-1])).max() <= -np.log(0.95) + 1e-9
    assert thickness(rope.curve) == pytest.approx(1.001 * rope.unit)


def test_open_ropes_end_on_fewer_vertices(monkeypatch):
    """Unless a number is given: they stay polygons, for which twice as many take minutes."""
    asked = []
    monkeypatch.setitem(
        tightening.__wrapped__.__globals__, "_tightened", lambda *given: asked.append(given[4]) or iter(())
    )
    for curve in (HOPF, BESIDE):
        for vertices in (None, 300):
            tightening(Task(curve=curve), TightenOptions(vertices=vertices))
    assert asked == [800, 300, 400, 301]  # arcs are cut once at least


def test_every_third_drawing_is_spread_a_little_only():
    """The others, and the given curve, as far as they go: so that starts come to different shapes."""
    spread, start = tightening.__wrapped__.__globals__["_spread"], Task(curve=knot("4_1", 60))
    thick = 0.5 * thickness(start.curve)
    ways = [spread(start, thick, thick, False, number)[1] for number in range(4)]
    assert [len(list(islice(way, 21))) for way in ways] == [21, 21, 21, 20]
    thin, same = (spread(start, thick, share * thick, False, 0)[1] for share in (0.1, 1.0))
    for one, other in islice(zip(thin, same, strict=True), 3):
        assert np.array_equal(one.curve.vertices, other.curve.vertices), "however thin the rope is"


def test_of_starts_that_come_to_the_same_shape_the_given_curve_goes_on(monkeypatch):
    thinned, refined, lengths, done = PulledRope.thinned, PulledRope.refined, {}, set()

    def numbered(rope, count):
        lengths[id(rope)] = 26.0 - 0.5 * len(lengths)  # the later starts seem to be shorter
        return thinned(rope, count)

    def noted(rope, vertices):
        done.add(id(rope))
        return refined(rope, vertices)

    monkeypatch.setattr(PulledRope, "thinned", numbered)
    monkeypatch.setattr(PulledRope, "refined", noted)
    monkeypatch.setattr(PulledRope, "promise", property(lambda rope: lengths[id(rope)]))
    monkeypatch.setitem(tightening.__wrapped__.__globals__, "redrawn", lambda *_: [HOPF, HOPF])
    iterates, outcome = run(HOPF, vertices=200, starts=3)
    assert len(iterates[-1].curve) == 200
    assert "no motion" not in str(outcome.message)
    assert len(done) == 1


def test_of_several_starts_the_shortest_goes_on_and_a_seed_tells_which():
    alone, _ = run(HOPF, vertices=100)
    several, again = (run(HOPF, vertices=100, starts=2, seed=4)[0] for _ in range(2))
    assert several[-1].energy <= alone[-1].energy * (1.0 + 2e-6)
    assert [each.energy for each in several] == [each.energy for each in again]
    check(several)


def test_that_the_shortest_begins_elsewhere_is_told(monkeypatch):
    monkeypatch.setitem(tightening.__wrapped__.__globals__, "redrawn", lambda *_: [Curve(CIRCLE)])
    _, outcome = run(HOPF, vertices=100, starts=2)
    assert "no motion from the given curve" in str(outcome.clauses[-2])


def test_an_overhand_knot_is_pulled_by_its_ends():
    loose = overhand(100)
    iterates = list(islice(tightening(Task(curve=loose), TightenOptions(vertices=200)), 25))
    check(iterates)
    ends = [np.linalg.norm(each.curve.vertices[-1] - each.curve.vertices[0]) for each in iterates]
    assert (np.diff(ends) >= 0.0).all()
    assert ends[-1] > 1.2 * ends[0]
    assert iterates[-1].curve.length == pytest.approx(loose.length, rel=1e-6)  # no rope is lost
    middles = [each.curve.vertices[[0, -1]].mean(axis=0) for each in iterates]
    assert np.ptp(middles, axis=0).max() < 1e-9  # both ends point to one side, and the knot would go there


def test_rope_that_is_drawn_out_of_a_knot_counts_as_progress():
    """The length stays, so that nothing else would tell that the rope is not at rest."""
    first = next(tightening(Task(curve=overhand(100)), TightenOptions(vertices=200)))
    rope = PulledRope(first, first.radius[0])
    merits = [rope.point.merit for _ in islice(rope.pulled(), 15)]
    assert merits[-1] < merits[0] - 10.0
    assert rope.curve.length == pytest.approx(first.curve.length, rel=1e-3)


def test_what_closed_ropes_lose_is_not_drawn_out_of_open_ones():
    first = next(tightening(Task(curve=BESIDE), TightenOptions(vertices=200)))
    rope = PulledRope(first, first.radius[0])
    drawn = max(rope.point.drawn for _ in islice(rope.pulled(), 30)) * rope.unit
    lost = first.curve.component_lengths[1] - rope.curve.component_lengths[1]
    assert lost > 0.5
    assert drawn < 0.2 * lost


def test_vertices_double_where_open_ropes_touch_and_ends_stay():
    """But for the size of the whole."""
    first = next(tightening(Task(curve=overhand(100)), TightenOptions(vertices=200)))
    rope, n = PulledRope(first, first.radius[0]), len(first.curve)
    touching = SimpleNamespace(i=np.array([50, 3]), j=np.array([120, 150]), strands=1)  # then corners
    before, rope.point = rope.curve.vertices - rope.center, SimpleNamespace(gap=0.0, contacts=touching)
    assert list(rope.refined(800))
    after = rope.curve.vertices - rope.center
    assert len(after) == n + 71 + 2 * 4  # edges from one to the other, and some beyond
    scale = np.linalg.norm(after[1]) / np.linalg.norm(before[1])
    np.testing.assert_allclose(after[:46], scale * before[:46], rtol=1e-9)
    np.testing.assert_allclose(after[125 - n :], scale * before[125 - n :], rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "held"),
    [
        ("open-square", 28.1),
        *(
            pytest.param(name, held, marks=pytest.mark.slow)
            for name, held in (
                ("overhand", 20.2),
                ("open-figure-eight", 27.4),
                ("open-granny", 30.1),
                ("sheet-bend", 31.6),
                ("bowline", 44.4),
            )
        ),
    ],
)
def test_rope_knots_are_pulled_tight_by_their_ends(name, held):
    loose = knot(name)
    iterates, outcome = run(loose, vertices=200)
    assert outcome.converged, outcome.message
    check(iterates)
    last = iterates[-1].curve
    outermost = np.ptp(last.vertices[:, 0]) - np.ptp(loose.vertices[:, 0])
    assert outermost > 5.0 * iterates[-1].radius[0]
    assert held < float(outcome.message.split(" radii")[0].split()[-1]) < 1.03 * held  # of 400 vertices


@pytest.mark.parametrize("shift", [0.0, 7.0])
def test_of_a_bend_the_rope_counts_that_its_ends_could_give(shift):
    """Of two bights whose ends reach out by nine: what is left of the length is between the legs, twice six."""
    bight = np.array([[-9.0, 3.0, 0.0], [0.0, 3.0, 0.0], [0.0, -3.0, 0.0], [-9.0, -3.0, 0.0]])
    bend = Curve.from_components([bight + shift, bight * [-1.0, 1.0, 1.0] + [0.0, 0.0, 5.0] + shift], (False, False))
    assert InteriorPoint(bend, 1.0, lambda vertices: True).excess == pytest.approx(12.0)


def test_a_rope_without_a_knot_becomes_straight():
    t = np.linspace(-2.0, 2.0, 21)
    wave = Curve(np.stack([t, np.sin(3 * t), 0.3 * np.cos(2 * t)], axis=1), Mesh((21,), (False,)))
    iterates, outcome = run(wave, vertices=100)
    assert outcome.converged
    assert outcome.message == "the rope is straight, as no knot was in it"
    assert outcome.ropelength == 0.0
    last = iterates[-1].curve
    assert np.linalg.norm(last.vertices[-1] - last.vertices[0]) == pytest.approx(last.length, rel=1e-6)


def test_many_vertices_are_thinned_out():
    iterates = list(islice(tightening(Task(curve=knot("3_1", 300)), TightenOptions(vertices=100)), 30))
    assert {len(each.curve) for each in iterates} >= {300, 100}
    check(iterates)


@pytest.mark.parametrize(
    ("given", "error", "said"),
    [
        (Task(curve=knot("3_1"), pins=(1,)), OptionError, "leave pins and obstacles out"),
        (Curve([[0, 0], [1, 0], [0, 1]]), CurveError, "dimension 2"),
        (Curve([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]), CurveError, "touch or cross"),
    ],
    ids=["pins", "plane", "through itself"],
)
def test_what_cannot_be_pulled_tight_is_refused(given, error, said):
    with pytest.raises(error, match=said):
        tighten(given)


@pytest.mark.parametrize("settings", [{"vertices": 10}, {"starts": 0}, {"seed": -1}])
def test_numbers_out_of_range_are_refused(settings):
    with pytest.raises(OptionError, match="must be"):
        tighten(knot("3_1"), **settings)


def test_a_time_limit_that_is_up_before_the_start_is_refused():
    with pytest.raises(OptionError, match="was up before the start"):
        list(tightening(Task(curve=knot("3_1")), TightenOptions(time_limit=1e-9)))


def test_when_the_time_is_up_the_shortest_start_so_far_is_kept():
    ticks = count()
    several = tightening(Task(curve=HOPF), TightenOptions(vertices=100, starts=3))
    limited = WithOutcome(within(TimeLimit(100, lambda: next(ticks)), several))
    energies = [iterate.energy for iterate in limited]
    assert limited.outcome.status is Status.TIME_LIMIT
    assert energies[-1] < 0.95 * energies[0]


def test_of_an_interrupted_comparison_the_shortest_start_so_far_is_kept():
    ticks = count()

    def interrupted():
        if next(ticks) == 100:
            raise KeyboardInterrupt
        return 0.0

    several = tightening(Task(curve=HOPF), TightenOptions(vertices=100, starts=3))
    limited, energies = within(TimeLimit(1.0, interrupted), several), []
    with pytest.raises(KeyboardInterrupt):
        energies.extend(each.energy for each in limited)
    assert energies[-1] < 0.95 * energies[0]


def test_an_open_rope_beside_a_closed_one_keeps_its_length():
    result = tighten(BESIDE, vertices=200)
    assert result.status is Status.CONVERGED
    assert "radii" not in result.message  # the ring's length is not counted
    assert result.outcome.ropelength == pytest.approx(result.curve.length / thickness(result.curve))
    assert result.outcome.residual <= 1e-5
    assert result.curve.component_lengths[0] == pytest.approx(BESIDE.component_lengths[0], rel=1e-2)
    assert result.curve.component_lengths[1] < 0.9 * BESIDE.component_lengths[1]


@pytest.mark.parametrize(
    ("vertices", "said"),
    [
        (CIRCLE + 1e4, r"1e\+04 from the origin, too far for ropes of radius 0\..*; move it there"),
        (CIRCLE + 1e9, r"1e\+09 from the origin, too far .*; move it there"),
        (CIRCLE * 1e4 + 1e7, r"1e\+07 from the origin, too far .*; move it there"),
        ([[0, 0, 0], [1e5, 0, 0], [1e5, 1e-3, 0], [0, 1e5, 0]], r"1e\+05 wide, too much for .*; smooth or relax it"),
    ],
)
def test_what_has_too_few_digits_for_its_thickness_is_refused_at_once(vertices, said):
    with pytest.raises(CurveError, match=said):
        tighten(Curve(vertices))


def test_a_rope_may_be_thinner_but_not_thicker_than_the_curve():
    thin, thick = (tighten(HOPF, vertices=100, radius=radius) for radius in (0.1, 9.0))
    for result, radius in ((thin, 0.1), (thick, 9.0)):
        assert result.status is Status.CONVERGED
        assert thickness(result.curve) == pytest.approx(min(radius, 0.9 * thickness(HOPF)), rel=1e-5)
        assert result.outcome.ropelength == pytest.approx(8.0 * np.pi, rel=1e-2)
        assert ("which fits the curve" in result.message) == (radius > 1.0)


def test_a_radius_that_is_too_small_is_refused():
    with pytest.raises(CurveError, match=r"2 wide, too much for ropes of radius 0\.0001; give a larger radius"):
        tighten(Curve(CIRCLE), radius=1e-4)


def test_thin_open_ropes_are_as_thin_as_their_vertices_allow():
    result = tighten(overhand(), vertices=200, radius=0.001)
    assert result.status is Status.CONVERGED
    assert thickness(result.curve) == pytest.approx(overhand().length / 1200.0, rel=1e-3)


def test_components_of_few_vertices_get_more_and_do_not_keep_others_from_having_less():
    coarse = CIRCLE[::5]
    fine = subdivide(Curve(CIRCLE), np.full(60, 16)).vertices
    result = tighten(Curve.from_components([fine, coarse[:, [0, 2, 1]] + [1.0, 0.0, 0.0]]), vertices=200)
    assert len(result.curve) <= 400
    assert len(result.curve.components[1]) >= 32
    assert result.outcome.ropelength == pytest.approx(8.0 * np.pi, rel=3e-3)
