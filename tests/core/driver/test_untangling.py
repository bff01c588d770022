"""Strand moves within a run: when they are made, what iterates and reports say of them, and what they must not lose."""

from itertools import count, islice

import numpy as np
import pytest
from mobius_flow.core import Curve, Objective, RelaxOptions, Status, Task, minimize, relax
from mobius_flow.core.base.deadline import TimeLimit, check_time
from mobius_flow.core.base.messages import Message
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.descent.task import Units
from mobius_flow.core.driver.moves import untangling
from mobius_flow.core.driver.outcome import converged
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import knot, overhand, scramble
from mobius_flow.core.untangle import Legs
from shapes import regular_polygon
from solids import plate
from tasks import proved

EASY = knot("braid(1,-2,3)", 40)  # an unknot of four crossings, and two moves
GOERITZ = knot("goeritz")


def plates(curve, part):
    """Two plates that leave a curve between them so much more room, as a part of its size."""
    low, high = curve.vertices[:, 2].min(), curve.vertices[:, 2].max()
    gap = part * np.ptp(curve.vertices, axis=0).max()
    return plate(low - gap, name="below"), plate(high + gap, name="above")


def test_by_default_the_flow_comes_first_and_is_all_that_is_needed():
    result = minimize(GOERITZ)
    assert (result.status, result.last.strand_moves) == (Status.CONVERGED, None)
    assert result.final_energy == pytest.approx(4.0, abs=1e-4)


def test_where_the_flow_makes_no_headway_strands_are_moved_and_the_flow_ends_it(monkeypatch):
    monkeypatch.setattr(untangling.Untangling, "often", 0)
    result, iterates = proved(GOERITZ)
    assert result.status is Status.CONVERGED
    assert result.final_energy == pytest.approx(4.0, abs=1e-4)
    assert "crossings are left to the flow" in result.message
    moved = [each for each in iterates if each.strand_moves and not each.strand_moves.done]
    assert moved[0].index == 2, "after one step, which is judged to be no headway"
    changes = [each for each in iterates if each.strand_moves and each.strand_moves.done and not each.path]
    assert result.iterations == len(iterates) - len(moved) - len(changes) - 1, "less the start, and new targets"
    told = result.report()["strand_moves"]
    assert told == result.last.strand_moves.report()
    assert told["left"] < told["crossings"] / 2
    assert told["moves"] > 0
    assert len(result.curve) >= len(iterates[0].curve)


def test_headway_is_a_hundredth_of_the_energy_in_a_hundred_iterations():
    curve = Task.of(knot("0_1")).refined(None).curve
    run = Run(start_problem(Task.of(curve), RelaxOptions()), curve, RelaxOptions())
    for fall, headway in ((0.0, False), (0.009, False), (0.011, True)):
        run.energies.clear()
        run.energies.extend(np.linspace(100.0, 100.0 * (1.0 - fall), 100))
        assert run.makes_headway, "not judged yet"
        run.energies.append(100.0 * (1.0 - fall))
        assert run.makes_headway == headway


@pytest.mark.slow
def test_the_flow_alone_is_stuck_on_hakens_unknot_but_not_with_strand_moves():
    result, iterates = proved(knot("haken"))
    assert result.final_energy == pytest.approx(4.0, abs=1e-4)
    assert next(each.index for each in iterates if each.strand_moves) > untangling.Untangling.often


@pytest.fixture(scope="module")
def easy():
    """A run with strand moves, two iterations of the flow, and a clock that ticks when somebody looks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(untangling.time, "perf_counter", count().__next__)
        return proved(EASY, untangle="always", max_iterations=2, tolerance=1e-9)


def test_energies_within_a_move_are_those_of_its_end(easy):
    _, iterates = easy
    moves = {}
    for each in iterates[1:-2]:
        moves.setdefault(each.strand_moves and each.strand_moves._replace(iterates=0), []).append(each)
    for each in moves.values():
        end = each[-1].curve
        value = Objective().value(end.with_vertices(Units.of(end).from_user(end.vertices)))
        np.testing.assert_allclose([iterate.energy for iterate in each], value, rtol=1e-9)
    left = [moves.left for moves in moves if moves]
    assert left == sorted(left, reverse=True)


def test_strand_moves_are_no_iterations(easy):
    result, _ = easy
    assert (result.status, result.iterations) == (Status.ITERATION_LIMIT, 2)
    assert result.message.startswith("stopped at the iteration limit (2)")
    assert result.last.strand_moves.left == 0


def _cut(monkeypatch, crossings, stop):
    """Have strand moves stopped in the middle of the next one, once so few crossings are left."""
    whole = untangling.untangled

    def cut(*given):
        left = crossings + 1
        for stage in whole(*given):
            if left <= crossings:
                yield stage._replace(path=stage.path[:1], crossings=left)
                stop()
            left = stage.crossings
            yield stage

    monkeypatch.setattr(untangling, "untangled", cut)


@pytest.mark.parametrize(
    ("ending", "crossings", "kept"), [("time limit", 8, False), ("interrupt", 8, False), ("time limit", 3, True)]
)
def test_what_is_cut_short_within_a_move_says_where_it_stands(ending, crossings, kept, monkeypatch):
    def stop():
        monkeypatch.setattr(TimeLimit, "is_reached", True)
        check_time()
        raise KeyboardInterrupt

    _cut(monkeypatch, crossings, stop)
    monkeypatch.setattr(untangling.Untangling, "often", 0)
    limit = 1e6 if ending == "time limit" else None
    result, iterates = proved(GOERITZ, time_limit=limit, untangle="always" if kept else "auto")
    assert result.status is (Status.TIME_LIMIT if limit else Status.INTERRUPTED)
    assert (result.last.strand_moves is not None) is kept
    said = "and {} of 11 crossings are left" if kept else "but with {} of 11 crossings left nothing is kept of that"
    left = [result.last.strand_moves.left] if kept else range(6, crossings + 1)
    assert any(result.message.endswith("; strands were being moved, " + said.format(count)) for count in left)
    check_embedded(result.curve)
    assert kept or len(iterates) == 2


def test_seconds_of_all_moves_are_counted(easy):
    seconds = sorted({each.strand_moves.seconds for each in easy[1] if each.strand_moves})
    assert seconds == list(range(1, len(seconds) + 1))
    assert len(seconds) > 1


def test_components_have_their_own_lengths_again():
    curve = scramble(knot("L2a1", 40), 2, moves=800)
    result, _ = proved(curve, untangle="always", max_iterations=2)
    assert result.last.strand_moves.left == 2
    np.testing.assert_allclose(result.curve.component_lengths, curve.component_lengths, rtol=1e-6)


@pytest.mark.parametrize(
    ("curve", "options", "said"),
    [
        (EASY, {"max_iterations": 0}, "strand moves: none, as there are to be no iterations"),
        (
            GOERITZ,
            {"avoid": plates(GOERITZ, 0.5), "grow": 1.2},
            "strand moves: none, as what grows between pins or among obstacles is left to the flow",
        ),
        (GOERITZ, {"pins": tuple(range(len(GOERITZ)))}, "strand moves: none are made"),
        (Curve(regular_polygon(12, 2).vertices * [1.0, 2.0]), {"max_iterations": 3}, "only curves in space"),
        (overhand(60), {"pins": (0, 59)}, "others would undo a knot between pinned ends"),
    ],
    ids=["no iterations", "confined", "all pinned", "plane", "pinned ends"],
)
def test_where_strands_are_not_moved_it_is_told(curve, options, said):
    result, _ = proved(curve, **{"untangle": "always", "max_iterations": 1} | options)
    assert said in result.message
    assert result.report()["strand_moves"] is None


@pytest.mark.slow
def test_moves_that_leave_more_crossings_than_go_are_in_vain(monkeypatch):
    monkeypatch.setattr(untangling.Untangling, "often", 0)
    curve = knot("tuzun-sikora")
    start, stuck, after = islice(relax(Task(curve=curve, obstacles=plates(curve, 0.003))), 3)
    assert start.curve.mesh == stuck.curve.mesh == after.curve.mesh
    assert after.strand_moves is None


def test_moves_that_stretch_the_curve_between_pins_are_refused(monkeypatch):
    def far(curve, pins, *_):
        away = 9.0 * curve.length * ~np.isin(np.arange(len(curve)), pins)
        yield Legs(curve, (), 2, 0)
        yield Legs(curve, (curve.vertices + away[:, None],), 1, 1)
        return Message("one crossing is left")

    monkeypatch.setattr(untangling, "untangled", far)
    result = minimize(Task(curve=GOERITZ, pins=(2, 6)), RelaxOptions(untangle="always", max_iterations=1))
    assert "strand moves: none are made: others would stretch the curve between pins" in result.message


def test_what_fails_within_moves_loses_nothing(monkeypatch):
    def fails(*_):
        raise np.linalg.LinAlgError("singular")
        yield

    monkeypatch.setattr(untangling, "untangled", fails)
    result = minimize(GOERITZ, RelaxOptions(untangle="always", max_iterations=2))
    assert "strand moves: none are made: stopped where the curve is too degenerate: singular" in result.message


@pytest.mark.parametrize(("gone", "left", "made"), [(25, 30, False), (0, 0, False), (25, 25, True)])
def test_at_rest_no_more_crossings_may_stay_than_go(gone, left, made, monkeypatch):
    monkeypatch.setattr(untangling, "worth", lambda *_: (gone, left))
    result = minimize(GOERITZ, RelaxOptions(tolerance=1.0))
    assert (result.last.strand_moves is not None or "strand moves" in result.message) is made


def test_what_stalls_instead_keeps_what_else_was_said():
    outcome = converged(1e-5, 1e-4).adding("one thing").stalling("another")
    assert (outcome.status, outcome.clauses) == (Status.STALLED, ("stalled: another", "one thing"))
